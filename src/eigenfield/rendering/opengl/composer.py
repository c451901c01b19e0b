"""Equation 8 on a GPU: means and eigen textures, weighted and summed into one texture of the whole atlas."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.errors import FormatError
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import ViewPlane
from eigenfield.rendering.weight_map import component_rows, weight_map
from eigenfield.rendering.weights import ViewWeights

WHOLE_RECTANGLE = (0.0, 0.0, 1.0, 1.0)  # left, top, right, bottom
COMPOSE_DRAW_LAYERS = 64  # summed in one draw, as in compose.glsl
COMPOSE_REACH_TEXELS = 2  # that the widest filter reads beside a chart
GLSL_HEAD = "#version 330 core\n"

QUAD_GLSL = """#version 330 core
uniform vec4 rectangle;  // of the target: left, top, right, bottom in 0..1
in vec2 corner;
out vec2 own;
void main() {
  own = corner;
  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, corner) - 1.0, 0.0, 1.0);
}
"""
SPREAD_GLSL = """#version 330 core
uniform vec2 texel;      // of the target, in clip space
uniform vec2 shifts[SHIFTS];
in vec2 coordinate;
in vec3 onPlane;
out vec3 point;
void main() {
  point = onPlane;
  gl_Position = vec4(2.0 * coordinate - 1.0 + texel * shifts[gl_InstanceID], 0.0, 1.0);
}
"""
PLACE_GLSL = "in vec3 point;\nout vec4 place;\nvoid main() { place = placeOf(point); }\n"
SUM_GLSL = "in vec2 own;\nout vec4 colour;\nvoid main() { colour = sumTextures(own); }\n"
FINER_GLSL = "in vec2 own;\nout vec4 colour;\nvoid main() { colour = finerValue(own); }\n"
OPACITY_GLSL = "in vec2 own;\nout vec4 colour;\nvoid main() { colour = finerOpacity(own); }\n"


@dataclass(frozen=True, eq=False)
class _Part:
    """A mean or a basis on the GPU.

    Attributes:
        array: Four channels of a mean, or four textures of one channel, to a texel.
        rectangle: Left, top, right and bottom of its grid that it covers, 0..1.
        colours: (C, 3) R, G and B of the value 1 of each channel.
        scale: (groups, C, 4): value = stored * scale + bias.
        bias: (groups, C, 4).
        columns: Its textures among those of all bases; None: a mean.
        group: The first of its groups in the weight maps.
    """

    array: Any
    rectangle: tuple[float, float, float, float]
    colours: NDArray[np.float64]
    scale: NDArray[np.float64]
    bias: NDArray[np.float64]
    columns: slice | None = None
    group: int = 0


@dataclass(eq=False)
class _Grid:
    """What is summed at one size.

    Attributes:
        target: Texture of the sum.
        frame: Framebuffer of it.
        places: Texture of where each texel lies on the surface, made when a view needs it.
    """

    target: Any
    frame: Any
    parts: list[_Part] = field(default_factory=list)
    places: Any = None


class Composer:
    """Composes a texture for one viewpoint after the other, in the context and thread that it was made in.

    Attributes:
        texture: R, G, B and the opacity of sheets as half-floats, of the scene's whole atlas, with mip maps; row 0 is
            v = 0.
    """

    def __init__(self, context: Any, scene: Scene, mode: str) -> None:
        """Put a scene's textures on the GPU.

        Args:
            mode: Of the weights that texels look up, one of `WEIGHT_MODES`.

        Raises:
            FormatError: `unsupported-layout`: the scene is no picture.
        """
        self._made: list[Any] = []
        self._context, self._scene, self._mode = context, scene, mode
        self._rows = component_rows(scene)
        self._composed: Any = None
        self._maps: Any = None
        self._colours = _colours_of(scene)
        bodies = SUM_GLSL, FINER_GLSL, OPACITY_GLSL
        self._sum, self._finer, self._cover = (self._program(QUAD_GLSL, body) for body in bodies)
        corners = self.keep(context.buffer(np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32).tobytes()))
        set_uniforms(self._sum, stored=np.int32(0), places=np.int32(1), weightMaps=np.int32(2))
        for program in (self._finer, self._cover):
            set_uniforms(program, coarse=np.int32(0), rectangle=WHOLE_RECTANGLE)
        self._quads = {
            program: self.keep(context.vertex_array(program, [(corners, "2f", "corner")]))
            for program in (self._sum, self._finer, self._cover)
        }
        sheets = scene.proxy.sheets
        self._opacity = None if sheets is None else self._one_channel(sheets.opacity)
        self._whole, self._coarser = self._make_grids()
        self.texture = self._whole.target

    def keep(self, made: Any) -> Any:
        """Return an object of the GPU, which `release` will free."""
        self._made.append(made)
        return made

    def release(self) -> None:
        """Free everything on the GPU."""
        for made in self._made:
            made.release()
        self._made.clear()

    def compose(self, count: int, weights: ViewWeights | None, eye: NDArray[np.float64]) -> None:
        """Fill `texture`, unless it holds the same already.

        Args:
            weights: Of the whole view; None: each texel takes those of the place where its ray to `eye` meets the view
                plane.
            eye: (3,) the camera's centre.
        """
        place = eye.tobytes() if weights is None else weights.rows.tobytes() + weights.values.tobytes()
        wanted = (count, place, weights is None)
        if wanted == self._composed:
            return
        omega = None if weights is None else weights.blend(self._rows)
        if omega is None:
            self._make_rays()
            set_uniforms(self._sum, eye=_on_plane(self._scene.rig.view_plane, eye))
        self._context.enable_only(self._context.BLEND)
        self._context.blend_func = self._context.ONE, self._context.ONE
        for grid in (*self._coarser, self._whole):
            grid.frame.use()
            grid.frame.clear()
            for part in grid.parts:
                self._add(grid, part, count, omega)
        for grid in self._coarser:
            grid.target.use(0)
            self._quads[self._finer].render(self._context.TRIANGLE_STRIP)
        if self._opacity is not None:
            self._opacity.use(0)
            self._quads[self._cover].render(self._context.TRIANGLE_STRIP)
        self.texture.build_mipmaps()
        self._composed = wanted

    def _add(self, grid: _Grid, part: _Part, count: int, omega: NDArray[np.float64] | None) -> None:
        """Draw a part into its grid, as many groups at a time as the shader takes."""
        groups, channels = part.scale.shape[:2]
        factor = np.ones((groups, 1, 4))
        rays = omega is None and part.columns is not None
        if part.columns is not None:
            groups = min(groups, -(-count // 4))
            flat = factor.reshape(-1)
            flat[count:] = 0
            if omega is not None:
                own = omega[part.columns]
                flat[: len(own)] *= own
        scale, bias = part.scale * factor, part.bias * factor
        sharing, step = 4 if part.columns is None else 1, COMPOSE_DRAW_LAYERS // channels
        part.array.use(0)
        if rays:
            grid.places.use(1)
            self._maps.use(2)
        set_uniforms(self._sum, rectangle=part.rectangle, sharing=np.int32(sharing), channels=np.int32(channels))
        set_uniforms(self._sum, rayWeights=np.bool_(rays), colours=_pad_layers(part.colours))
        for first in range(0, groups, step):
            last = min(first + step, groups)
            layer = first * channels // sharing
            numbers = {"entries": (last - first) * channels, "firstLayer": layer, "firstGroup": part.group + first}
            set_uniforms(self._sum, **{name: np.int32(number) for name, number in numbers.items()})
            set_uniforms(self._sum, scale=_pad_layers(scale[first:last]), bias=_pad_layers(bias[first:last]))
            self._quads[self._sum].render(self._context.TRIANGLE_STRIP)

    def _program(self, vertex: str, body: str) -> Any:
        source = GLSL_HEAD + shader("cubic") + shader("compose") + body
        return self.keep(self._context.program(vertex_shader=vertex, fragment_shader=source))

    def _make_grids(self) -> tuple[_Grid, list[_Grid]]:
        """The grid of the whole atlas, which takes the others, and those that are coarser, with all parts."""
        whole = self._grid(*self._scene.appearance.atlas, mips=True)
        grids = {self._scene.appearance.atlas: whole}
        column = group = 0
        appearance = self._scene.appearance
        for plane, channels in zip(appearance.planes, appearance.channel_slices, strict=True):
            colours = self._colours[channels]
            for size in plane.sizes:
                if size not in grids:
                    grids[size] = self._grid(*size)
            grids[plane.sizes[0]].parts.append(self._mean(plane, colours))
            for basis in plane.bases:
                if basis.count:
                    columns = slice(column, column + basis.count)
                    grids[basis.size].parts.append(self._basis(basis, colours, columns, group))
                column, group = column + basis.count, group - (-basis.count // 4)
        return whole, [grid for grid in grids.values() if grid is not whole]

    def _grid(self, rows: int, columns: int, mips: bool = False) -> _Grid:
        target = self.keep(self._context.texture((columns, rows), 4, dtype="f2"))
        target.repeat_x = target.repeat_y = False
        if mips:
            target.build_mipmaps()
            target.filter = (self._context.LINEAR_MIPMAP_LINEAR, self._context.LINEAR)  # anisotropy: Mesa's blurs
        return _Grid(target, self.keep(self._context.framebuffer([target])))

    def _one_channel(self, picture: NDArray[np.float32]) -> Any:
        height, width = picture.shape
        data = np.ascontiguousarray(picture, np.float32)
        return _without_filter(self.keep(self._context.texture((width, height), 1, data, dtype="f4", alignment=1)))

    def _mean(self, plane: Plane, colours: NDArray[np.float64]) -> _Part:
        height, width, channels = plane.mean.shape
        texels = np.zeros((-(-channels // 4), 4, height, width), np.float32)
        texels.reshape(-1, height, width)[:channels] = plane.mean.transpose(2, 0, 1)
        data = np.ascontiguousarray(texels.transpose(0, 2, 3, 1))
        array = self._context.texture_array((width, height, len(data)), 4, data, dtype="f4", alignment=1)
        scale = np.tile(np.eye(4), (len(data), 1))[None, :channels]
        return _Part(_without_filter(self.keep(array)), WHOLE_RECTANGLE, colours, scale, np.zeros_like(scale))

    def _basis(self, basis: Basis, colours: NDArray[np.float64], columns: slice, group: int) -> _Part:
        """Four eigen textures to a texel, and the numbers that make values of what it stores."""
        count, height, width, channels = basis.textures.shape
        codes = basis.textures.dtype == np.uint8
        dtype, stored, full = ("f1", np.uint8, 255) if codes else ("f4", np.float32, 1)
        groups = -(-count // 4)
        array = self._context.texture_array((width, height, groups * channels), 4, dtype=dtype)
        self.keep(array)
        texels = np.zeros((height, width, 4), stored)  # of one layer: more than that is never held
        for layer in range(groups * channels):
            first, channel = 4 * (layer // channels), layer % channels
            four = basis.textures[first : first + 4, ..., channel]
            texels[..., : len(four)] = four.transpose(1, 2, 0)
            array.write(texels, viewport=(0, 0, layer, width, height, 1))
        scale, bias = np.zeros((2, 4 * groups, channels))
        scale[:count], bias[:count] = full * basis.scale, -basis.zero.astype(np.float64) * basis.scale
        scale, bias = (values.reshape(groups, 4, channels).transpose(0, 2, 1) for values in (scale, bias))
        (rows, wide), (top, left) = basis.size, basis.corner
        rectangle = (left / wide, top / rows, (left + width) / wide, (top + height) / rows)
        return _Part(_without_filter(array), rectangle, colours, scale, bias, columns, group)

    def _make_rays(self) -> None:
        """Make the weight maps and the places of the texels, for the first view that needs them."""
        grids = [grid for grid in (*self._coarser, self._whole) if any(part.columns for part in grid.parts)]
        if self._maps is not None or not grids:
            return
        found = weight_map(self._scene, self._mode)
        nodes, bases = len(found), [basis for plane in self._scene.appearance.planes for basis in plane.bases]
        counts = [basis.count for basis in bases]
        slots = np.concatenate([np.arange(n) + 4 * sum(-(-m // 4) for m in counts[:i]) for i, n in enumerate(counts)])
        layers = np.zeros((sum(-(-n // 4) for n in counts), 4, nodes, nodes), np.float32)
        layers.reshape(-1, nodes, nodes)[slots] = found.transpose(2, 0, 1)
        data = np.ascontiguousarray(layers.transpose(0, 2, 3, 1)).astype(np.float16)
        self._maps = self.keep(self._context.texture_array((nodes, nodes, len(data)), 4, data, dtype="f2"))
        self._maps.repeat_x = self._maps.repeat_y = False
        shifts = _neighbour_shifts()
        program = self._program(SPREAD_GLSL.replace("SHIFTS", str(len(shifts))), PLACE_GLSL)
        set_uniforms(program, shifts=shifts)
        mesh = self._scene.proxy.mesh
        assert mesh.uv is not None
        corners = np.concatenate([mesh.uv, _on_plane(self._scene.rig.view_plane, mesh.vertices)], axis=1)
        vertices = self._context.buffer(corners.astype(np.float32).tobytes())
        faces = self._context.buffer(np.ascontiguousarray(mesh.faces, np.int32).tobytes())
        layout = [(vertices, "2f 3f", "coordinate", "onPlane")]
        array = self._context.vertex_array(program, layout, index_buffer=faces)
        self._context.enable_only(self._context.NOTHING)
        for grid in grids:
            size = grid.target.size
            grid.places = self.keep(self._context.texture(size, 4, dtype="f2"))
            grid.places.filter = (self._context.NEAREST, self._context.NEAREST)
            frame = self._context.framebuffer([grid.places])
            frame.use()
            frame.clear()
            set_uniforms(program, texel=2 / np.array(size))
            array.render(instances=len(shifts))
            frame.release()
        for resource in (array, vertices, faces):
            resource.release()


def shader(name: str) -> str:
    """A GLSL body of `shaders/`, shared with the web viewer; its first lines say what stands before it."""
    return (resources.files("eigenfield.rendering") / "shaders" / f"{name}.glsl").read_text(encoding="utf-8")


def set_uniforms(program: Any, **values: ArrayLike) -> None:
    """Write uniforms, whole numbers as int. Those that the compiler found unused are left out."""
    for name, value in values.items():
        if name in program:
            array = np.asarray(value)
            program[name].write(array.astype("i4" if array.dtype.kind in "ib" else "f4").tobytes())


def _colours_of(scene: Scene) -> NDArray[np.float64]:
    """(K, 3): R, G and B of the value 1 of each channel of all planes."""
    channels = [int(plane.mean.shape[2]) for plane in scene.appearance.planes]
    if scene.appearance.to_rgb is not None and max(channels) <= COMPOSE_DRAW_LAYERS:
        return scene.appearance.to_rgb.T.astype(np.float64)
    if channels in ([1], [3]):
        return np.eye(3) if channels == [3] else np.ones((1, 3))
    message = "OpenGL draws one plane of one or three channels, or planes that a matrix makes R, G and B of"
    raise FormatError("unsupported-layout", message, where="planes", remedy="use the software renderer")


def _on_plane(view: ViewPlane, points: ArrayLike) -> NDArray[np.float64]:
    """(n, 3): X, Y of world points and their height above the view plane, in half widths of the array."""
    offset = np.asarray(points, np.float64).reshape(-1, 3) - view.origin
    height = offset @ np.cross(view.right, view.up) / (max(view.extent) or 1.0)
    return np.concatenate([view.coordinates(points), height[:, None]], axis=1)


def _neighbour_shifts() -> NDArray[np.float64]:
    """(n, 2) texels by which the mesh is drawn beside itself, the nearest last, which is the one that stays."""
    steps = np.arange(-COMPOSE_REACH_TEXELS, COMPOSE_REACH_TEXELS + 1.0)
    shifts = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    return shifts[np.argsort(-np.square(shifts).sum(axis=1), kind="stable")]


def _pad_layers(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """(COMPOSE_DRAW_LAYERS, n): what an array of the shader takes, zeros after the last of (..., n)."""
    flat = values.reshape(-1, values.shape[-1])
    padded = np.zeros((COMPOSE_DRAW_LAYERS, flat.shape[1]), np.float32)
    padded[: len(flat)] = flat
    return padded


def _without_filter(array: Any) -> Any:
    array.repeat_x = array.repeat_y = False
    array.filter = (array.ctx.NEAREST, array.ctx.NEAREST)
    return array
