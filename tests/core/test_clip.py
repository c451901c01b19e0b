"""A clip gives the scene of one frame, by its time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest

from eigenfield.core.clip import Clip, Frame, Group, Timeline
from eigenfield.core.errors import OptionError
from eigenfield.core.payloads import Payload, Payloads, mesh_key
from support.scenes import tiny_scene
from support.soft_scenes import soft_scene

SCENE = tiny_scene()
PLANE = SCENE.appearance.planes[0]
BASIS = PLANE.bases[0]


@dataclass(frozen=True, eq=False)
class GroupsInMemory:
    """Groups that are decoded already."""

    groups: tuple[Group, ...]

    @property
    def lengths(self) -> Sequence[int]:
        return [len(group.frames) for group in self.groups]

    def group(self, index: int) -> Group:
        return self.groups[index]


def frame(level: float, **more) -> Frame:
    return Frame((np.full_like(PLANE.mean, level),), ((np.full_like(BASIS.textures, -level),),), **more)


def group(*levels: float) -> Group:
    payloads = Payloads({mesh_key(SCENE.proxy.mesh): [Payload("mesh-2", b"mesh")]})
    return Group(SCENE.proxy, SCENE.appearance, [frame(level) for level in levels], payloads)


def clip(*groups: Group, first: float = 0.0) -> Clip:
    frames = sum(len(one.frames) for one in groups)
    return Clip(SCENE.rig, Timeline(Fraction(25), frames, first), GroupsInMemory(groups), {"textures": 3})


def test_the_times_of_a_timeline_are_spread_by_its_rate():
    timeline = Timeline(Fraction(30000, 1001), 3, first=2.0)
    np.testing.assert_allclose(timeline.times, [2.0, 2.0 + 1001 / 30000, 2.0 + 2002 / 30000], rtol=1e-15)


@pytest.mark.parametrize(
    ("time", "number"), [(1.0, 0), (0.981, 0), (1.019, 0), (1.021, 1), (1.04, 1), (1.12, 3), (1.139, 3)]
)
def test_the_nearest_frame_is_shown(time, number):
    assert Timeline(Fraction(25), 4, first=1.0).frame_at(time) == number


@pytest.mark.parametrize("time", [0.97, 1.15, -np.inf, np.nan])
def test_a_time_outside_is_refused_with_the_range(time):
    with pytest.raises(OptionError, match=r"no frame at .*give 1 to 1\.12 seconds") as caught:
        Timeline(Fraction(25), 4, first=1.0).frame_at(time)
    assert caught.value.code == "time"


def test_each_frame_of_each_group_is_a_scene():
    moving = clip(group(0.1, 0.2), group(0.3), group(0.4, 0.5, 0.6), first=7.0)
    for number, time in enumerate(moving.timeline.times):
        scene = moving.scene(time)
        plane = scene.appearance.planes[0]
        level = np.float32((number + 1) / 10)
        assert (plane.mean == level).all() and (plane.bases[0].textures == -level).all()
        assert plane.bases[0].weights is BASIS.weights and scene.rig is SCENE.rig
        assert scene.settings == {"textures": 3} and scene.rows().tolist() == [0, 1, 2, 3, 4]
        assert scene.payloads[mesh_key(scene.proxy.mesh)][0].data == b"mesh"


def test_vertices_and_opacity_are_those_of_the_frame():
    soft = soft_scene()
    plane, sheets = soft.appearance.planes[0], soft.proxy.sheets
    textures = (tuple(basis.textures for basis in plane.bases),)
    vertices, opacity = soft.proxy.mesh.vertices + 1, sheets.opacity / 2
    frames = [Frame((plane.mean,), textures), Frame((plane.mean,), textures, opacity, vertices)]
    payloads = Payloads({mesh_key(soft.proxy.mesh): [Payload("mesh-2", b"mesh")]})
    moving = Clip(
        soft.rig,
        Timeline(Fraction(1), 2),
        GroupsInMemory((Group(soft.proxy, soft.appearance, frames, payloads),)),
    )
    first, second = moving.scene(0.0), moving.scene(1.0)
    assert first.proxy is soft.proxy and len(first.payloads) == 1
    assert second.proxy.mesh.vertices is vertices and second.proxy.sheets.opacity is opacity
    assert second.proxy.mesh.faces is soft.proxy.mesh.faces and len(second.payloads) == 0


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (Frame((PLANE.mean[1:],), ((BASIS.textures,),)), "a mean"),
        (Frame((PLANE.mean,), ((BASIS.textures[:-1],),)), "eigen textures"),
        (Frame((PLANE.mean,), ((BASIS.textures.astype(np.float64),),)), "eigen textures"),
        (Frame((PLANE.mean,), ((),)), "argument"),
        (Frame((), ()), "argument"),
        (frame(0.5, vertices=SCENE.proxy.mesh.vertices[:-1]), "vertices"),
        (frame(0.5, opacity=np.ones((4, 4), np.float32)), "no sheets"),
    ],
)
def test_a_frame_of_other_shapes_is_refused(wrong, words):
    moving = clip(replace(group(0.1), frames=[wrong]))
    with pytest.raises(ValueError, match=words):
        moving.scene(0.0)


@pytest.mark.parametrize(
    "build",
    [
        lambda: Timeline(Fraction(0), 1),
        lambda: Timeline(Fraction(1), 0),
        lambda: Timeline(Fraction(1), 1, np.inf),
        lambda: Clip(SCENE.rig, Timeline(Fraction(1), 3), GroupsInMemory((group(0.1, 0.2),))),
        lambda: Clip(SCENE.rig, Timeline(Fraction(1), 1), GroupsInMemory((group(0.1), group()))),
    ],
)
def test_a_clip_whose_frames_do_not_add_up_is_refused(build):
    with pytest.raises(ValueError, match="frames"):
        build()
