"""
Broken descriptions and joint states for the two inputs of the node: `make fuzz`.

A target (`description_target`, `joint_state_target`) returns the answer to one input; an exception
is a finding. `mutated_xml`, `cdr` and `mutated_bytes` break inputs in ways chosen by hypothesis,
`campaign` counts, and `audit` forbids opening files, sockets and processes.

"""
