"""The legs of a URDF file: chains of three joints, found from the tree of links alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.urdf.document import MOVING, Joint, Link, UrdfDocument

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Chain", "Part", "Placed", "Tree", "legs_of"]

_JOINTS = 3
_FEWEST = 4


class Placed(NamedTuple):
    """A link with its place when all joints are at zero.

    Attributes
    ----------
    link : Link
        The link.
    T_body_link : array, shape (4, 4)
        Its pose in the frame of the body's link.
    """

    link: Link
    T_body_link: Float[np.ndarray, "4 4"]


class Part(NamedTuple):
    """Links that fixed joints connect, which move as one.

    Attributes
    ----------
    links : tuple of Placed
        The links; the others are fixed to the first.
    joints : tuple of Joint
        The joints, other than fixed ones, that start from them.
    """

    links: tuple[Placed, ...]
    joints: tuple[Joint, ...]


class Chain(NamedTuple):
    """A leg.

    Attributes
    ----------
    joints : tuple of Joint
        Coxa, femur and tibia joint.
    parts : tuple of Part
        What each of them moves, including what further joints move, which are held at zero.
    held : tuple of str
        Names of those further joints.
    """

    joints: tuple[Joint, ...]
    parts: tuple[Part, ...]
    held: tuple[str, ...]


class Tree(NamedTuple):
    """Body and legs.

    Attributes
    ----------
    body : Part
        The body, with links that belong to no leg, whose joints are held at zero.
    legs : tuple of Chain
        The legs.
    ignored : tuple of str
        Names of the joints that belong to no leg.
    """

    body: Part
    legs: tuple[Chain, ...]
    ignored: tuple[str, ...]


def legs_of(document: UrdfDocument, *, where: str) -> Tree:
    """Find the body, from which most legs start, and the legs.

    Parameters
    ----------
    document : UrdfDocument
        Links and joints.
    where : str
        Name of the file in messages.

    Raises
    ------
    InputError
        If links and joints do not form a tree, or fewer than four legs start from any link.
    """
    _check_tree(document, where)
    children: dict[str, list[Joint]] = {}
    for joint in document.joints:
        children.setdefault(joint.parent, []).append(joint)
    found = {name: [_depth(joint, children) for joint in _leaving(name, children)] for name in document.links}
    above = {joint.child: joint for joint in document.joints}
    # Of links fixed to one another several may lead to the same legs; the one nearest to the legs is the body.
    base = max(document.links, key=lambda name: (sum(depth >= _JOINTS for depth in found[name]), _level(name, above)))
    legs = sum(depth >= _JOINTS for depth in found[base])
    if legs < _FEWEST:
        raise InputError(
            f"{where}: found {legs} legs, chains of three revolute joints from one link ({base!r}); a robot has at "
            f"least {_FEWEST}"
        )
    top, T_base_top = base, np.eye(4)
    while top in above and above[top].kind == "fixed":
        T_base_top = T_base_top @ np.linalg.inv(above[top].T_parent_child)
        top = above[top].parent
    body = _part(document, top, T_base_top, children)
    chains = [_chain(document, body, joint, children) for joint in body.joints if _depth(joint, children) >= _JOINTS]
    others = [joint for joint in body.joints if _depth(joint, children) < _JOINTS]
    carried = [_everything(document, body, joint, children) for joint in others]
    links = (*body.links, *(placed for part, _ in carried for placed in part))
    ignored = tuple(name for _, names in carried for name in names)
    return Tree(Part(links, body.joints), tuple(chains), ignored)


def _check_tree(document: UrdfDocument, where: str) -> None:
    parents: dict[str, str] = {}
    for joint in document.joints:
        if joint.child in parents:
            raise InputError(f"{where}: the link {joint.child!r} is moved by more than one joint")
        parents[joint.child] = joint.parent
    for link in parents:
        above, steps = link, 0
        while above in parents:
            above, steps = parents[above], steps + 1
            if steps > len(parents):
                raise InputError(f"{where}: the joints from the link {link!r} on form a loop")


def _level(name: str, above: dict[str, Joint]) -> int:
    """Return how many joints lie between a link and the root."""
    level = 0
    while name in above:
        name, level = above[name].parent, level + 1
    return level


def _leaving(name: str, children: dict[str, list[Joint]]) -> list[Joint]:
    """Return the joints, other than fixed ones, that start from a link and from the links fixed to it."""
    found = []
    for joint in children.get(name, ()):
        found += _leaving(joint.child, children) if joint.kind == "fixed" else [joint]
    return found


def _depth(joint: Joint, children: dict[str, list[Joint]]) -> int:
    """Return how many moving joints follow one another from a joint on, itself included; 0 for one of another type."""
    if joint.kind not in MOVING:
        return 0
    return 1 + max((_depth(each, children) for each in _leaving(joint.child, children)), default=0)


def _part(
    document: UrdfDocument, name: str, T_body_link: Float[np.ndarray, "4 4"], children: dict[str, list[Joint]]
) -> Part:
    """Return a link with all links that are fixed to it."""
    links, joints = [Placed(document.links[name], T_body_link)], list[Joint]()
    for joint in children.get(name, ()):
        if joint.kind == "fixed":
            inner = _part(document, joint.child, T_body_link @ joint.T_parent_child, children)
            links += inner.links
            joints += inner.joints
        else:
            joints.append(joint)
    return Part(tuple(links), tuple(joints))


def _child(document: UrdfDocument, part: Part, joint: Joint, children: dict[str, list[Joint]]) -> Part:
    """Return what a joint moves, up to the next joints."""
    place = next(placed.T_body_link for placed in part.links if placed.link.name == joint.parent)
    return _part(document, joint.child, place @ joint.T_parent_child, children)


def _everything(
    document: UrdfDocument, part: Part, joint: Joint, children: dict[str, list[Joint]]
) -> tuple[list[Placed], list[str]]:
    """Return all links that a joint moves, and the names of it and of all joints behind it."""
    child = _child(document, part, joint, children)
    links, names = list(child.links), [joint.name]
    for each in child.joints:
        inner, more = _everything(document, child, each, children)
        links += inner
        names += more
    return links, names


def _chain(document: UrdfDocument, body: Part, first: Joint, children: dict[str, list[Joint]]) -> Chain:
    """Return the leg that starts with a joint; where it branches, along the branch with most joints."""
    joints, parts = [first], [_child(document, body, first, children)]
    held: list[str] = []
    while True:
        part = parts[-1]
        onward = max(part.joints, key=lambda joint: _depth(joint, children), default=None)
        leg = onward if len(joints) < _JOINTS else None
        for joint in part.joints:
            if joint is not leg:
                links, names = _everything(document, part, joint, children)
                held += names
                parts[-1] = Part((*parts[-1].links, *links), part.joints)
        if leg is None:
            return Chain(tuple(joints), tuple(parts), tuple(held))
        joints.append(leg)
        parts.append(_child(document, part, leg, children))
