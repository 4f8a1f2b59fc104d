"""docs/workspace.png: gravity load and largest payload over the workspace of arm7."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
import numpy as np

TOOL = 'tool_center'
CELL = 0.03  # m
STEPS = (121, 141, 41)  # positions of shoulder, elbow and wrist
PITCHES = ('shoulder_pitch', 'elbow_pitch', 'wrist_pitch')


def worst_by_place(robot):
    """
    Return gravity load and payload of the worst posture with the tool in each cell.

    All postures in the vertical plane in front of the robot: the three pitch joints on a grid
    over their ranges, the others at zero.

    Parameters
    ----------
    robot : RobotModel
        arm7.

    Returns
    -------
    reach, height : ndarray
        Edges of the cells, m.
    share : ndarray, shape (heights, reaches)
        Largest gravity torque relative to its effort limit, without payload; NaN: out of reach.
    payload : ndarray, shape (heights, reaches)
        Largest mass at the tool, kg; NaN: out of reach.

    """
    q = postures(robot)
    x, z = tool_places(robot, q)
    share = np.max(np.abs(robot.gravity_torque(q)) / robot.effort_limits, axis=1)
    payload = robot.max_payload(q, TOOL)[0]
    reach = np.arange(0.0, x.max() + CELL, CELL)
    height = np.arange(np.floor(z.min() / CELL) * CELL, z.max() + CELL, CELL)
    column, row = (
        np.floor((place - edges[0]) / CELL).astype(int)
        for place, edges in ((x, reach), (z, height))
    )
    size = len(height) - 1, len(reach) - 1
    inside = (x >= 0.0) & (column < size[1]) & (row < size[0])
    cells = row[inside], column[inside]
    largest = np.full(size, -np.inf)
    least = np.full(size, np.inf)
    np.maximum.at(largest, cells, share[inside])
    np.minimum.at(least, cells, payload[inside])
    seen = np.isfinite(least)
    return reach, height, np.where(seen, largest, np.nan), np.where(seen, least, np.nan)


def postures(robot):
    """Return the positions of the grid, shape (N, n), rad or m."""
    rows = [robot.joint_names.index(name) for name in PITCHES]
    grids = np.meshgrid(
        *(np.linspace(*robot.position_limits[row], count) for row, count in zip(rows, STEPS)),
        indexing='ij',
    )
    q = np.zeros((grids[0].size, len(robot.joint_names)))
    for row, grid in zip(rows, grids):
        q[:, row] = grid.ravel()
    return q


def tool_places(robot, q):
    """
    Return reach and height of the tool, each of shape (N,), m.

    From the potential energy of one kilogram there, V = m g z for gravity along z, and the same
    for gravity along x.

    """

    def along(axis):
        gravity = np.zeros(3)
        gravity[axis] = -1.0  # m/s^2
        turned = robot.with_gravity(gravity)
        return turned.with_payload(TOOL, 1.0).potential_energy(q) - turned.potential_energy(q)

    return along(0), along(2)


def draw(robot, path):
    """
    Write the picture.

    Parameters
    ----------
    robot : RobotModel
        arm7.
    path : Path
        PNG file.

    """
    reach, height, share, payload = worst_by_place(robot)
    figure = Figure(figsize=(8.3, 4.6), dpi=200, layout='constrained')
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, sharey=True)
    for axis, values, colors, levels, label, title in (
        (
            left,
            100.0 * share,
            'YlOrRd',
            (10, 20, 30, 40, 45),
            '% of the effort limit',
            'gravity takes',
        ),
        (right, payload, 'YlGnBu', (5, 6, 7, 8, 9), 'kg', 'and leaves for a payload'),
    ):
        # No colors for the 60 kg near the top, where the bearings carry the load.
        mesh = axis.pcolormesh(
            reach,
            height,
            values,
            cmap=colors,
            rasterized=True,
            vmin=0.8 * levels[0],
            vmax=levels[-1] * (1.35 if axis is right else 1.1),
        )
        lines = axis.contour(
            (reach[1:] + reach[:-1]) / 2,
            (height[1:] + height[:-1]) / 2,
            values,
            levels,
            colors='#333333',
            linewidths=0.7,
        )
        axis.clabel(lines, fontsize=7.5)
        bar = figure.colorbar(
            mesh, ax=axis, shrink=0.85, pad=0.02, extend='max' if axis is right else 'neither'
        )
        bar.set_label(label, fontsize=9)
        bar.ax.tick_params(labelsize=8)
        axis.plot([0, 0, 0], [0.0, 0.16, 0.33], '-o', color='#22262d', lw=4, ms=5)
        axis.set_title(title, fontsize=10, fontweight='bold')
        axis.set_xlabel('reach of the tool [m]', fontsize=9)
        axis.set(aspect='equal')
        axis.tick_params(labelsize=8)
        axis.spines[['top', 'right']].set_visible(False)
    left.set_ylabel('height of the tool [m]', fontsize=9)
    figure.savefig(path)
