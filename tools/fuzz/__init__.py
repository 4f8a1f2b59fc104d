"""
Broken descriptions and joint states through the two targets of the node: `make fuzz`.

A target (`description_target`, `joint_state_target`) takes one input and says how it was answered;
anything but an answer is a finding. `mutated_xml`, `cdr` and `mutated_bytes` break inputs on
purpose, hypothesis chooses how, `campaign` counts, and `audit` sees that nothing is opened.

"""
