"""Everything that one run has measured."""

from dataclasses import dataclass, field


@dataclass
class Results:
    """
    What the report is rendered from; no other number gets into it.

    Attributes
    ----------
    facts : dict of str to str
        Machine, versions, commit.
    libraries : dict of str to str
        Name → version, of those that were measured.
    notes : dict of str to str
        Name → what its calls include.
    missing : dict of str to str
        Name → why it was not measured.
    refused : list of str
        Sentences about what was not timed because its numbers differ.
    rounds : int
    joints : dict of str to int
        Number of joints of each arm.
    single : list of Row
    batch : list of BatchRow
    batch_count : int
        States in a batch.
    memory : dict or None
        As `memory.peak_besides_result` returns it.
    growth : list of GrowthRow
    sections : dict of str to Section
        'node'.
    seconds : float
        How long the run took.

    """

    facts: dict
    libraries: dict = field(default_factory=dict)
    notes: dict = field(default_factory=dict)
    missing: dict = field(default_factory=dict)
    refused: list = field(default_factory=list)
    rounds: int = 0
    joints: dict = field(default_factory=dict)
    single: list = field(default_factory=list)
    batch: list = field(default_factory=list)
    batch_count: int = 0
    memory: dict | None = None
    growth: list = field(default_factory=list)
    sections: dict = field(default_factory=dict)
    seconds: float = 0.0
