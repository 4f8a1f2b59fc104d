"""docs/floating.png and docs/floating.webp: a run of the demo, rendered and plotted."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from .rendering import ArmRenderer, over

DEGREE = '°'
WIDTH, PANEL_HEIGHT = 4.15, 3.7  # inches; 400 dpi / 2 make 1660 pixels, twice a README's column
DPI = 200
PANEL = (406, 430)  # pixels of a rendered panel
LOOKAT, DISTANCE = (0.30, 0.0, 0.40), 2.35

OFF, ON, PUSHED, PAUSE = '#f6cfc7', '#d3ecd8', '#fbeabb', '#ececec'
PHASE_COLORS = {
    'falls, node off': OFF,
    'back to the start': PAUSE,
    'ramps up': PAUSE,
    'held by the node': ON,
    'pushed': PUSHED,
    'held there': ON,
    'ramps down': PAUSE,
}
LINE_COLORS = ['#1f4e9e', '#d1495b', '#2e9e6b', '#e08e1b', '#7a4fb5', '#2aa7b8', '#8c5a3c']
GHOSTS = 4
MOVIE_SIZE, MOVIE_RATE = (560, 400), 12  # pixels, pictures per second
# Speed of phases in the movie: long ones are shortened.
SPEED = {'held by the node': 5.0, 'back to the start': 2.0, 'held there': 1.5}
MOVIE_WORDS = {
    'falls, node off': 'output off: it falls',
    'back to the start': 'driven back',
    'ramps up': 'output on',
    'held by the node': 'output on: it floats (5 x)',
    'pushed': 'pushed: it gives way',
    'held there': 'and stays there',
}


def draw(outcome, arm, robot, path):
    """
    Write the picture of the README's first screen.

    Parameters
    ----------
    outcome : Outcome
        Result of the demo.
    arm : MujocoArm
        The arm of the demo.
    robot : Path
        Its URDF.
    path : Path
        PNG file.

    """
    figure = Figure(figsize=(2 * WIDTH, 2 * WIDTH * 0.565), dpi=DPI)
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(
        2,
        4,
        height_ratios=[1.3, 1.0],
        left=0.065,
        right=0.998,
        top=0.93,
        bottom=0.105,
        hspace=0.13,
        wspace=0.03,
    )
    renderer = ArmRenderer(robot, *PANEL, LOOKAT, DISTANCE)
    for column, (title, color, ghosts, place) in enumerate(_panels(outcome)):
        axis = figure.add_subplot(grid[0, column])
        picture = np.empty((PANEL[1], PANEL[0], 3))
        picture[:] = [int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
        for position in ghosts:
            picture = over(picture, renderer.frame(_all_joints(arm, position)), 0.3)
        axis.imshow(over(picture, renderer.frame(_all_joints(arm, place))))
        axis.set_title(title, fontsize=9.5, fontweight='bold')
        axis.set(xticks=[], yticks=[])
        axis.spines[:].set_visible(False)
    renderer.close()
    _plot(figure.add_subplot(grid[1, :]), outcome)
    figure.savefig(path)
    # 128 colors: a third of the file size.
    with Image.open(path) as picture:
        picture.convert('RGB').quantize(
            128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE
        ).save(path, optimize=True)


def film(outcome, arm, robot, path):
    """
    Write the same run as a movie.

    Parameters
    ----------
    outcome, arm, robot
        See `draw`.
    path : Path
        WebP file.

    """
    renderer = ArmRenderer(robot, *MOVIE_SIZE, LOOKAT, DISTANCE * 0.93)
    times, positions = outcome.recording.times(), outcome.recording.positions()
    font = ImageFont.load_default(26)
    pictures = []
    for phase in outcome.recording.phases:
        if phase.name not in MOVIE_WORDS:
            continue
        step = SPEED.get(phase.name, 1.0) / MOVIE_RATE
        for time in np.arange(phase.start, phase.end, step):
            picture = np.empty((MOVIE_SIZE[1], MOVIE_SIZE[0], 3))
            color = PHASE_COLORS[phase.name]
            picture[:] = [int(color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
            place = positions[np.searchsorted(times, time)]
            picture = over(picture, renderer.frame(_all_joints(arm, place)))
            image = Image.fromarray(np.round(255.0 * picture).astype(np.uint8))
            ImageDraw.Draw(image).text((16, 12), MOVIE_WORDS[phase.name], '#22262d', font)
            pictures.append(image)
    renderer.close()
    pictures[0].save(
        path,
        save_all=True,
        append_images=pictures[1:],
        loop=0,
        duration=round(1000 / MOVIE_RATE),
        quality=60,
        method=6,
    )


def _panels(outcome):
    """Return title, color, intermediate and last positions of the four panels."""
    fall, push = (_phase(outcome, name) for name in ('falls, node off', 'pushed'))
    watched = _phase(outcome, 'held there')
    return [
        (
            f'output off: falls {outcome.largest(outcome.fall):.0f}{DEGREE} in 1 s',
            OFF,
            _on_the_way(outcome, fall),
            outcome.poses['after the fall'],
        ),
        (f'output on: held for {outcome.hold:.0f} s', ON, [], outcome.poses['held']),
        (
            f'pushed by {outcome.largest(outcome.pushed):.0f}{DEGREE}: gives way',
            PUSHED,
            _on_the_way(outcome, push),
            _at(outcome, push.end),
        ),
        (
            f'let go: stays for {watched.end - watched.start:.0f} s',
            ON,
            [],
            outcome.poses['after the push'],
        ),
    ]


def _plot(axis, outcome):
    """Draw the joint displacements over the phases."""
    recording = outcome.recording
    start = recording.phases[0].start - 0.2
    times = recording.times() - start
    way = recording.natural(recording.positions() - outcome.poses['start'])
    moved = np.flatnonzero(recording.turning & (np.ptp(way, axis=0) > 1.0))
    for phase in recording.phases:
        axis.axvspan(phase.start - start, phase.end - start, color=PHASE_COLORS[phase.name], lw=0)
    for color, row in zip(LINE_COLORS, moved):
        axis.plot(
            times, way[:, row], lw=1.6, color=color, label=recording.names[row].replace('_', ' ')
        )
    middle = {
        name: (_phase(outcome, name).start + _phase(outcome, name).end) / 2 - start
        for name in ('held by the node', 'pushed', 'held there')
    }
    drifts = (outcome.largest(outcome.drift), outcome.largest(outcome.drift_after_push))
    for name, words in (
        ('held by the node', f'held: drift {_small(drifts[0])}'),
        ('pushed', 'pushed'),
        ('held there', f'drift {_small(drifts[1])}'),
    ):
        axis.text(
            middle[name],
            0.965,
            words,
            fontsize=8.5,
            ha='center',
            va='top',
            transform=axis.get_xaxis_transform(),
        )
    end = recording.phases[-1].end - start
    axis.set(xlim=(0.0, end))
    axis.set_xlabel('time [s]', fontsize=8.5, labelpad=1)
    axis.set_ylabel(f'joints from start [{DEGREE}]', fontsize=8.5, labelpad=2)
    axis.tick_params(labelsize=8)
    held = _phase(outcome, 'held by the node')
    axis.legend(
        fontsize=7.5,
        ncols=2,
        frameon=False,
        loc='center',
        bbox_to_anchor=((held.start + held.end) / 2 - start, 0.66),
        bbox_transform=axis.get_xaxis_transform(),
    )
    axis.spines[['top', 'right']].set_visible(False)


def _small(degrees):
    """Return a small angle; a rounded zero would look like a missing value."""
    return f'{degrees:.2f}{DEGREE}' if degrees >= 0.01 else f'< 0.01{DEGREE}'


def _phase(outcome, name):
    """Return a phase of the run."""
    return next(phase for phase in outcome.recording.phases if phase.name == name)


def _at(outcome, time):
    """Return the position at a time of the recording, shape (n,) [rad or m]."""
    recording = outcome.recording
    return recording.positions()[min(np.searchsorted(recording.times(), time), len(recording) - 1)]


def _on_the_way(outcome, phase):
    """Return positions of a motion at equal distances."""
    recording = outcome.recording
    times = recording.times()
    part = recording.positions()[(times >= phase.start) & (times <= phase.end)]
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(part, axis=0)).max(1))))
    places = np.searchsorted(way, np.linspace(0.0, way[-1], GHOSTS, endpoint=False))
    return [part[place] for place in places]


def _all_joints(arm, driven):
    """Return the position of each joint by name, mimic joints included."""
    return dict(zip(arm.names, arm.mimic_matrix @ driven + arm.mimic_offset))
