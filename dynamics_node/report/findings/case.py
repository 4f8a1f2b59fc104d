"""A robot on which findings are made: who carries what, and how large it is."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..report import Report
from ..study import Study
from ...urdf import Examination

# Samples at which D is compared.
_SAMPLES = 256


@dataclass(frozen=True)
class Case:
    """
    What findings are made from.

    Attributes
    ----------
    report : Report
        Without findings.
    examination : Examination
    study : Study or None
        Of the robot; of a refused one with its impossible inertials mended, so that effects can
        be told; None if there is no tree at all.

    """

    report: Report
    examination: Examination
    study: Study | None

    @property
    def known(self) -> Study:
        """The study, where there is one."""
        assert self.study is not None
        return self.study

    @property
    def description(self):
        """The robot description."""
        return self.examination.description

    @cached_property
    def links(self):
        """`Link` by name."""
        return {link.name: link for link in self.description.links}

    @cached_property
    def entries(self):
        """`LinkEntry` by name."""
        return {entry.name: entry for entry in self.report.links}

    @cached_property
    def joints(self):
        """`Joint` by name."""
        return {joint.name: joint for joint in self.description.joints}

    @cached_property
    def moved(self):
        """Entries of the links that joints move."""
        return [entry for entry in self.report.links if entry.carrier is not None]

    @cached_property
    def moved_with_mass(self):
        """Those of them that weigh something."""
        return [entry for entry in self.moved if entry.mass > 0.0]

    @cached_property
    def moving_mass(self):
        """Of what joints move, kg."""
        return sum(entry.mass for entry in self.moved_with_mass)

    @cached_property
    def any_shapes(self):
        """Whether the URDF gives shapes at all; where it does not, they tell nothing."""
        return any(link.has_shape for link in self.description.links)

    @cached_property
    def body_mass(self):
        """Mass of each moving body by its joint, kg."""
        masses = dict.fromkeys((joint.name for joint in self.report.joints), 0.0)
        for entry in self.moved_with_mass:
            masses[entry.carrier] += entry.mass
        return masses

    @cached_property
    def body_parent(self):
        """Of each movable joint the movable joint before it; None: the base."""
        return {
            joint.name: self.entries[joint.parent].carrier
            for joint in self.report.joints
            if joint.parent in self.entries
        }

    @cached_property
    def body_children(self):
        """Of each movable joint those right behind it."""
        children: dict[str, list] = {name: [] for name in self.body_parent}
        for name, parent in self.body_parent.items():
            if parent in children:
                children[parent].append(name)
        return children

    @cached_property
    def mass_behind(self):
        """Of each movable joint, mass of all bodies behind its own, kg."""
        behind = dict.fromkeys(self.body_parent, 0.0)
        for name in self.body_parent:
            above, seen = self.body_parent[name], {name}
            while above is not None and above not in seen:
                seen.add(above)
                behind[above] += self.body_mass[name]
                above = self.body_parent.get(above)
        return behind

    @cached_property
    def joints_at(self):
        """Of each link, where the joints that it carries are: distances from its frame, m."""
        distances: dict[str, list] = {name: [] for name in self.links}
        for joint in self.description.joints:
            if joint.parent in distances:
                distances[joint.parent].append(float(np.linalg.norm(joint.placement[:3, 3])))
        return distances

    def size(self, link):
        """
        Return how far a link goes, as far as the URDF tells without its shapes, m.

        From its frame to its center of mass and to the joints that it carries, and from the joint
        before it.

        """
        com = self.entries[link].com
        return max(
            [
                0.0 if com is None else float(np.linalg.norm(com)),
                *self.joints_at[link],
                *self._step_to.get(link, []),
            ]
        )

    def size_without_com(self, link):
        """Return the same without the center of mass."""
        return max([0.0, *self.joints_at[link], *self._step_to.get(link, [])])

    @cached_property
    def _step_to(self):
        return {
            joint.child: [float(np.linalg.norm(joint.placement[:3, 3]))]
            for joint in self.description.joints
        }

    @cached_property
    def reach(self):
        """Length of the longest chain, m: no joint is further from the root link."""
        above = {joint.child: joint for joint in self.description.joints}
        longest = 0.0
        for link in self.links:
            name, length, seen = link, 0.0, set()
            while name in above and name not in seen:
                seen.add(name)
                joint = above[name]
                length += float(np.linalg.norm(joint.placement[:3, 3]))
                if joint.kind == 'prismatic' and np.isfinite([joint.lower, joint.upper]).all():
                    length += max(abs(joint.lower), abs(joint.upper))
                name = joint.parent
            longest = max(longest, length)
        return longest

    @cached_property
    def sampled_inertia(self):
        """Diagonal of D at some samples, shape (S, n)."""
        return self.diagonal_of(self.known.model)

    def diagonal_of(self, model):
        """Return the diagonal of a model's D at some samples, shape (S, n)."""
        matrices = model.mass_matrix(self.known.positions[:_SAMPLES])
        return np.diagonal(matrices, axis1=1, axis2=2)
