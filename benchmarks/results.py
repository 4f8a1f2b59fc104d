"""The results of one run."""

from dataclasses import dataclass, field


@dataclass
class Results:
    """
    All numbers of the report.

    Attributes
    ----------
    facts : dict of str to str
        Machine, versions, commit.
    libraries : dict of str to str
        Name → version of each measured library.
    notes : dict of str to str
        Name → description of its calls.
    missing : dict of str to str
        Name → reason why it was not measured.
    refused : list of str
        A sentence for each call that was not timed because its results differ.
    rounds : int
    joints : dict of str to int
        Number of joints of each arm.
    single : list of Row
    batch : list of BatchRow
    batch_count : int
        States in a batch.
    memory : dict or None
        As `memory.peak_besides_result` returns it.
    scaling : list of ScalingRow
    sections : dict of str to Section
        'node'.
    seconds : float
        Duration of the run.

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
    scaling: list = field(default_factory=list)
    sections: dict = field(default_factory=dict)
    seconds: float = 0.0
