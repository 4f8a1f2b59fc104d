"""A progress bar on standard error, gone when the report is there."""

from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn


@contextmanager
def progress_bar():
    """
    Show how far the report is.

    Yields
    ------
    callable(fraction, what)
        As `make_report` wants it.

    """
    with Progress(
        BarColumn(),
        TextColumn('{task.percentage:>3.0f} %'),
        TextColumn('{task.description}', markup=False),
        console=Console(stderr=True),
        transient=True,
    ) as progress:
        task = progress.add_task('', total=1.0)
        yield lambda fraction, what: progress.update(task, completed=fraction, description=what)
