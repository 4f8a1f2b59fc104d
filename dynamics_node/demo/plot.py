"""demo.png: joint displacements, motor efforts and poses of a run."""

from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
import numpy as np

from .mujoco_arm import MujocoArm
from .recording import Phase
from .story import FALL_TIME, Outcome, WATCH_TIME

PHASE_COLORS = {
    'falls, node off': '#f4b6ac',
    'back to the start': '#e4e4e4',
    'held by the node': '#bfe3c5',
    'pushed': '#fbe3a6',
    'held there': '#bfe3c5',
    'ramps up': '#cfdff5',
    'ramps down': '#cfdff5',
}
POSE_COLORS = {
    'start': '#3b3f46',
    'after the fall': '#c8442f',
    'held': '#2b8a3e',
    'after the push': '#c98a00',
}
LEAD_IN = 0.3  # [s] before the first phase
NARROW = 0.12  # share of the run; the name of a shorter phase stands inside it, upright
JOINT_COLORS = [
    '#1f4e9e',
    '#d1495b',
    '#2e9e6b',
    '#e08e1b',
    '#7a4fb5',
    '#2aa7b8',
    '#8c5a3c',
    '#c653a2',
    '#6b7280',
    '#a3b018',
]


def draw(outcome: Outcome, arm: MujocoArm, name: str, path: Path) -> None:
    """Write the figure."""
    figure = Figure(figsize=(12, 10), dpi=120, layout='constrained')
    FigureCanvasAgg(figure)
    figure.suptitle(_title(outcome, name), fontsize=13, fontweight='bold')
    grid = figure.add_gridspec(3, len(outcome.poses), height_ratios=[1.25, 1.1, 1.0])
    figures = [figure.add_subplot(grid[0, column]) for column in range(len(outcome.poses))]
    _draw_poses(figures, outcome, arm)
    moved = figure.add_subplot(grid[1, :])
    _draw_displacement(moved, outcome)
    _draw_effort(figure.add_subplot(grid[2, :], sharex=moved), outcome)
    figure.savefig(path)


def _title(outcome: Outcome, name: str) -> str:
    """Return the headline: the four displacements."""
    return (
        f'{name}: falls {outcome.largest(outcome.fall):.0f}° in {FALL_TIME:.0f} s '
        'without the node, '
        f'drifts {_small(outcome.largest(outcome.drift))} in {outcome.hold:.0f} s with it\n'
        f'pushed, it yields {outcome.largest(outcome.pushed):.0f}°, stays there and drifts '
        f'{_small(outcome.largest(outcome.drift_after_push))} in {WATCH_TIME:.0f} s'
    )


def _small(degrees: float) -> str:
    """Return a small angle; a rounded zero would look like a missing value."""
    return f'{degrees:.2f}°' if degrees >= 0.01 else 'less than 0.01°'


def _draw_poses(axes: list[Any], outcome: Outcome, arm: MujocoArm) -> None:
    """Draw one stick figure per pose, from the side, all at the same scale."""
    sticks = {pose: arm.skeleton(position) for pose, position in outcome.poses.items()}
    titles = {
        'start': 'start',
        'after the fall': f'node off: {FALL_TIME:.0f} s later',
        'held': f'node on: {outcome.hold:.0f} s later',
        'after the push': 'pushed: stays there',
    }
    view = _side(sticks['start'][-1])
    flat = {pose: np.stack([stick @ view, stick[:, 2]], axis=1) for pose, stick in sticks.items()}
    points = np.vstack(list(flat.values()))
    middle, half = (points.max(0) + points.min(0)) / 2, np.ptp(points, axis=0).max() * 0.58
    for axis, (pose, stick) in zip(axes, flat.items()):
        axis.plot(*flat['start'].T, color='#b9bdc4', lw=5, solid_capstyle='round', zorder=1)
        _draw_stick(axis, stick, POSE_COLORS[pose])
        axis.set_title(titles[pose], color=POSE_COLORS[pose], fontsize=11, fontweight='bold')
        axis.set(
            xlim=(middle[0] - half, middle[0] + half),
            ylim=(middle[1] - half, middle[1] + half),
            aspect='equal',
        )
        axis.tick_params(labelsize=8)
        axis.grid(alpha=0.25)
    axes[0].set_ylabel('height [m]')
    for axis in axes:
        axis.set_xlabel('reach [m]', fontsize=9)


def _draw_stick(axis: Any, stick: np.ndarray, color: str) -> None:
    """Draw one arm, shape (k, 2) [m]: links, joints and the end."""
    axis.plot(*stick.T, color=color, lw=4, solid_capstyle='round', zorder=2)
    axis.plot(*stick[1:-1].T, 'o', color='white', markeredgecolor=color, markersize=6, zorder=3)
    axis.plot(*stick[-1], 's', color=color, markersize=7, zorder=3)
    axis.plot(*stick[0], '^', color='#3b3f46', markersize=11, zorder=3)


def _side(tip: np.ndarray) -> np.ndarray:
    """Return the horizontal direction of the arm, shape (3,)."""
    radius = np.hypot(tip[0], tip[1])
    return np.array([tip[0], tip[1], 0.0]) / radius if radius > 1e-3 else np.array([1.0, 0, 0])


def _draw_displacement(axis: Any, outcome: Outcome) -> None:
    """Draw the displacement of each joint from its start."""
    recording = outcome.recording
    times = recording.times() - recording.phases[0].start
    way = recording.natural(recording.positions() - outcome.poses['start'])
    for row, name in enumerate(recording.names):
        unit = '' if recording.turning[row] else ' [mm]'
        axis.plot(times, way[:, row], lw=1.8, color=_color(row), label=name + unit)
    _shade(axis, recording.phases, wide=True)
    axis.set_ylabel('displacement [° or mm]')
    axis.legend(fontsize=8, loc='center left', bbox_to_anchor=(1.0, 0.5), frameon=False)
    axis.grid(alpha=0.25)
    axis.tick_params(labelbottom=False)


def _draw_effort(axis: Any, outcome: Outcome) -> None:
    """Draw the motor efforts."""
    recording = outcome.recording
    times, efforts = recording.times() - recording.phases[0].start, recording.efforts()
    for row in range(len(recording.names)):
        axis.plot(times, efforts[:, row], lw=1.5, color=_color(row))
    _shade(axis, recording.phases, wide=False)
    axis.set(ylabel='motor effort [N m or N]', xlabel='time [s]', xlim=(-LEAD_IN, times[-1]))
    axis.grid(alpha=0.25)


def _shade(axis: Any, phases: list[Phase], wide: bool) -> None:
    """Color the background by phase; name wide phases above it, narrow ones inside."""
    origin, total = phases[0].start, phases[-1].end - phases[0].start
    for phase in phases:
        start, end = phase.start - origin, phase.end - origin
        axis.axvspan(start, end, color=PHASE_COLORS[phase.name], alpha=0.55, lw=0)
        if wide != (end - start > NARROW * total):
            continue
        axis.text(
            (start + end) / 2,
            1.02 if wide else 0.04,
            phase.name,
            fontsize=9,
            ha='center',
            va='bottom',
            rotation=0 if wide else 90,
            transform=axis.get_xaxis_transform(),
            zorder=5,
            bbox=None if wide else {'facecolor': 'white', 'alpha': 0.6, 'lw': 0, 'pad': 1},
        )


def _color(row: int) -> str:
    """Return a joint's color, the same in both diagrams."""
    return JOINT_COLORS[row % len(JOINT_COLORS)]
