"""
Broken descriptions and joint states through the two doors of the node: `make fuzz`.

A door (`description_door`, `joint_state_door`) takes one input and says how it was answered;
anything but an answer is a finding. `mutated_xml`, `cdr` and `mutated_bytes` break inputs on
purpose, hypothesis chooses how, `campaign` counts, and `audit` sees that nothing is opened.

"""
