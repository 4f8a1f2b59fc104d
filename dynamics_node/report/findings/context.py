"""The robot under examination, with the derived data that the checks share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..report import LinkEntry, Report
from ..workspace_analysis import WorkspaceAnalysis
from ...dynamics import RobotModel
from ...urdf import Inertial, Joint, Link, PartialRead, RobotDescription

# Number of samples at which D is compared.
_SAMPLES = 256


@dataclass(frozen=True)
class FindingContext:
    """
    Input of all checks.

    Attributes
    ----------
    report : Report
        Without findings.
    examination : PartialRead
    analysis : WorkspaceAnalysis or None
        Of the robot. For a refused robot its impossible inertials are replaced, so that effects
        can be computed. None without a kinematic tree.

    """

    report: Report
    examination: PartialRead
    analysis: WorkspaceAnalysis | None

    def require_analysis(self) -> WorkspaceAnalysis:
        """Return the analysis; only for robots that have one."""
        assert self.analysis is not None
        return self.analysis

    @property
    def description(self) -> RobotDescription:
        """The robot description."""
        return self.examination.description

    @cached_property
    def links(self) -> dict[str, Link]:
        """Links by name."""
        return {link.name: link for link in self.description.links}

    @cached_property
    def entries(self) -> dict[str, LinkEntry]:
        """Link entries by name."""
        return {entry.name: entry for entry in self.report.links}

    @cached_property
    def joints(self) -> dict[str, Joint]:
        """Joints by name."""
        return {joint.name: joint for joint in self.description.joints}

    def inertial(self, link: str) -> Inertial:
        """Return the inertial parameters of a link that has them."""
        inertial = self.links[link].inertial
        assert inertial is not None
        return inertial

    @cached_property
    def moved(self) -> list[LinkEntry]:
        """Entries of the links that joints move."""
        return [entry for entry in self.report.links if entry.carrier is not None]

    @cached_property
    def moved_with_mass(self) -> list[LinkEntry]:
        """Entries of the moving links with a positive mass."""
        return [entry for entry in self.moved if entry.mass > 0.0]

    @cached_property
    def moving_mass(self) -> float:
        """Sum of the masses that joints move, kg."""
        return sum(entry.mass for entry in self.moved_with_mass)

    @cached_property
    def has_shapes(self) -> bool:
        """Whether the URDF contains shapes; without any, a missing shape means nothing."""
        return any(link.has_shape for link in self.description.links)

    @cached_property
    def body_mass(self) -> dict[str, float]:
        """Mass of each moving body by its joint, kg."""
        masses = dict.fromkeys((joint.name for joint in self.report.joints), 0.0)
        for entry in self.moved_with_mass:
            if entry.carrier is not None:
                masses[entry.carrier] += entry.mass
        return masses

    @cached_property
    def body_parent(self) -> dict[str, str | None]:
        """The movable joint before each movable joint; None for the base."""
        return {
            joint.name: self.entries[joint.parent].carrier
            for joint in self.report.joints
            if joint.parent in self.entries
        }

    @cached_property
    def body_children(self) -> dict[str, list[str]]:
        """The movable joints directly behind each movable joint."""
        children: dict[str, list[str]] = {name: [] for name in self.body_parent}
        for name, parent in self.body_parent.items():
            if parent in children:
                children[parent].append(name)
        return children

    @cached_property
    def mass_behind(self) -> dict[str, float]:
        """Mass of all bodies behind the body of each movable joint, kg."""
        behind = dict.fromkeys(self.body_parent, 0.0)
        for name in self.body_parent:
            above, visited = self.body_parent[name], {name}
            while above is not None and above not in visited:
                visited.add(above)
                behind[above] += self.body_mass[name]
                above = self.body_parent.get(above)
        return behind

    @cached_property
    def joint_distances(self) -> dict[str, list[float]]:
        """Distances of the joints that each link carries from the link's frame, m."""
        distances: dict[str, list[float]] = {name: [] for name in self.links}
        for joint in self.description.joints:
            if joint.parent in distances:
                distances[joint.parent].append(_length(joint))
        return distances

    def size(self, link: str) -> float:
        """
        Return the extent of a link as far as the URDF tells without its shapes, m.

        The largest of the distances from its frame to its center of mass and to the joints that
        it carries, and of the distance from the joint before it.

        """
        com = self.entries[link].com
        return max(0.0 if com is None else float(np.linalg.norm(com)), self.size_without_com(link))

    def size_without_com(self, link: str) -> float:
        """Return the extent of a link without its center of mass, m."""
        return max([0.0, *self.joint_distances[link], *self._step_to.get(link, [])])

    @cached_property
    def _step_to(self) -> dict[str, list[float]]:
        return {joint.child: [_length(joint)] for joint in self.description.joints}

    @cached_property
    def reach(self) -> float:
        """Length of the longest chain, m: no joint is farther from the root link."""
        above = {joint.child: joint for joint in self.description.joints}
        longest = 0.0
        for link in self.links:
            name, length, visited = link, 0.0, set()
            while name in above and name not in visited:
                visited.add(name)
                joint = above[name]
                length += _length(joint)
                if joint.kind == 'prismatic' and np.isfinite([joint.lower, joint.upper]).all():
                    length += max(abs(joint.lower), abs(joint.upper))
                name = joint.parent
            longest = max(longest, length)
        return longest

    @cached_property
    def sampled_inertia(self) -> NDArray[np.float64]:
        """Diagonal of D at the first samples, shape (S, n)."""
        return self.diagonal_of(self.require_analysis().model)

    def diagonal_of(self, model: RobotModel) -> NDArray[np.float64]:
        """Return the diagonal of a model's D at the first samples, shape (S, n)."""
        matrices = model.mass_matrix(self.require_analysis().positions[:_SAMPLES])
        return np.diagonal(matrices, axis1=1, axis2=2)


def _length(joint: Joint) -> float:
    return float(np.linalg.norm(joint.placement[:3, 3]))
