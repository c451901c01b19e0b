"""The OpenGL renderer: off screen on any GPU through EGL, with the shader of the web viewer (equations 7 and 8)."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import resources
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.camera import Camera
from eigenfield.errors import FormatError, OptionError
from eigenfield.rendering.drawing import ONE_SAMPLE, make_surface, median_footprint
from eigenfield.rendering.picture import Picture
from eigenfield.rendering.renderer import BLACK, background_of
from eigenfield.rendering.weight_map import component_rows, weight_map
from eigenfield.scene import Basis, Scene

FILTERS = ("bilinear", "mixed", "bicubic")  # BICUBIC 0, 1, 2 of the shader
VERSION = 330  # OpenGL 3.3: texture arrays, and GLSL that reads as WebGL2's does

VERTEX = """#version 330 core
uniform mat4 toClip;
in vec3 position;
in vec2 coordinate;
out vec3 place;
out vec2 uv;
void main() {
  place = position;
  uv = coordinate;
  gl_Position = toClip * vec4(position, 1.0);
}
"""
FRAGMENT = """
in vec3 place;
in vec2 uv;
out vec4 colour;
void main() {
  colour = vec4(surfaceColour(uv, place), 1.0);
}
"""


def surface_source() -> str:
    """The GLSL body that every renderer on a GPU includes; its head says what goes before it."""
    return (resources.files("eigenfield.rendering") / "shaders" / "surface.glsl").read_text(encoding="utf-8")


class OpenGLRenderer:
    """Draws a scene with OpenGL; to be used from the thread that made it, and closed (it is a context manager).

    filter: `bilinear`, `bicubic` (Catmull-Rom), or `mixed`: bicubic for the mean, bilinear for the eigen textures,
    which is nearly as good and much faster (decision 11). weights: the mode of the weights that fragments look up.
    multisample: samples of a pixel's edges, 0 for none. context: a moderngl context to draw in, else one of its own.

    Raises OptionError (`opengl-missing`: moderngl is not installed; `opengl-context`: no driver, or one below OpenGL
    3.3; `opengl-memory`: the textures are too many or too large for it), FormatError `unsupported-layout` for scenes
    other than one plane of one or three channels with means and bases that fit.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        filter: str = "bicubic",
        weights: str = "delaunay",
        multisample: int = 0,
        context: Any = None,
    ) -> None:
        _check_filter(filter)
        self._bases = _checked_bases(scene)
        self._scene = scene
        self._mode = weights
        self._multisample = multisample
        self._owned = context is None
        self._made: list[Any] = []
        self._kept: tuple[tuple[int, int], Any, Any] | None = None
        self.context: Any = make_context() if context is None else context
        try:
            self._set_up(filter)
        except Exception as error:
            self.close()
            if type(error).__module__.startswith("moderngl"):
                raise OptionError(
                    "opengl-memory",
                    f"{self.count} textures of this scene do not fit the OpenGL driver: {error}",
                    remedy="use the software renderer",
                ) from error
            raise

    @property
    def count(self) -> int:
        """N, the eigen textures of all bases."""
        return sum(basis.count for basis in self._bases)

    @property
    def name(self) -> str:
        """What draws: the driver's own words."""
        return str(self.context.info["GL_RENDERER"])

    def __enter__(self) -> OpenGLRenderer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give everything on the GPU back."""
        for made in self._made:
            made.release()
        self._made.clear()
        self._release_frames()
        if self._owned and self.context is not None:
            self.context.release()
        self.context = None

    def draw(
        self,
        camera: Camera,
        weights: ArrayLike | None = None,
        *,
        background: Sequence[float] = BLACK,
        textures: int | None = None,
        colour: NDArray[np.float32] | None = None,
    ) -> Picture:
        """The view of `camera`, values exact to 1 / 255.

        weights: view weights (Ne,) over the encoded cameras, as for the software renderer. None: each point of the
        surface takes those of the place where its ray to the camera meets the view plane, which is right for a camera
        anywhere; on the plane it is the same. The rest as `Renderer.draw`.
        """
        data = self.draw_rgba(camera, weights, textures=textures, colour=colour).astype(np.float32) / np.float32(255)
        image, coverage = data[..., :3], np.ascontiguousarray(data[..., 3])
        image = image + (1 - coverage)[..., None] * background_of(background, 3)
        return Picture(np.ascontiguousarray(image), coverage)

    def draw_rgba(
        self,
        camera: Camera,
        weights: ArrayLike | None = None,
        *,
        textures: int | None = None,
        colour: NDArray[np.float32] | None = None,
    ) -> NDArray[np.uint8]:
        """(H, W, 4) uint8, R, G, B times coverage, and coverage: what the GPU holds after `paint`."""
        frame = self.paint(camera, weights, textures=textures, colour=colour)
        data = np.frombuffer(frame.read(components=4), np.uint8)
        return data.reshape(camera.height, camera.width, 4)[::-1]

    def paint(
        self,
        camera: Camera,
        weights: ArrayLike | None = None,
        *,
        textures: int | None = None,
        colour: NDArray[np.float32] | None = None,
    ) -> Any:
        """Draw into a framebuffer that stays on the GPU, bottom row first, and is drawn over by the next call."""
        if textures is not None and textures < 0:
            raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")
        count = self.count if textures is None else min(textures, self.count)
        drawn, resolved = self._frames(camera.width, camera.height)
        self._set("toClip", _clip_matrix(camera, self._middle, self._radius).T)
        self._set("eye", camera.centre - self._middle)
        self._set("count", np.int32(count))
        self._set("rayWeights", np.bool_(weights is None))
        if weights is None:
            self._weight_maps()
        else:
            omega = np.zeros(self._groups * 4)
            omega[: self.count] = np.asarray(weights, np.float64) @ self._rows
            self._set("viewWeights", omega)
        gain, offset = (np.ones(3), np.zeros(3)) if colour is None else np.asarray(colour, np.float64)
        self._set("exposureScale", 1 / gain)
        self._set("exposureBias", -offset / gain)
        drawn.use()
        self.context.enable_only(self.context.DEPTH_TEST)
        drawn.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        for unit, texture in enumerate((self._mean, self._eigen, self._maps)):
            if texture is not None:
                texture.use(unit)
        self._array.render()
        if resolved is not drawn:
            self.context.copy_framebuffer(resolved, drawn)
        return resolved

    def _set_up(self, filter: str) -> None:
        context, scene, plane = self.context, self._scene, self._scene.planes[0]
        mesh, view = scene.mesh, scene.view_plane
        self._rows = component_rows(scene)
        self._groups = -(-max(self.count, 1) // 4)
        channels = plane.mean.shape[2]
        head = f"#version 330 core\n#define COUNT {max(self.count, 1)}\n#define CHANNELS {channels}\n"
        head += f"#define BICUBIC {FILTERS.index(filter)}\n"
        self._program = self._keep(
            context.program(vertex_shader=VERTEX, fragment_shader=head + surface_source() + FRAGMENT)
        )
        # about the middle of the mesh: float32 keeps few digits where the world's origin is far away
        low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
        self._middle, self._radius = (low + high) / 2, float(np.linalg.norm(high - low) / 2) or 1.0
        assert mesh.uv is not None
        corners = np.concatenate([mesh.vertices - self._middle, mesh.uv], axis=1).astype(np.float32)
        vertices = self._keep(context.buffer(corners.tobytes()))
        faces = self._keep(context.buffer(np.ascontiguousarray(mesh.faces, np.int32).tobytes()))
        layout = [(vertices, "3f 2f", "position", "coordinate")]
        self._array = self._keep(context.vertex_array(self._program, layout, index_buffer=faces))
        self._mean = _filtered(self._keep(context.texture(*_texture_of(plane.mean), dtype="f4", alignment=1)))
        self._eigen = self._upload_bases()
        self._maps: Any = None
        for unit, name in enumerate(("meanTexture", "eigenTextures", "weightMaps")):
            self._set(name, np.int32(unit))
        self._set("meanScale", np.ones(3))
        self._set("meanBias", np.zeros(3))
        self._set("toRGB", np.eye(3))
        height, width = plane.mean.shape[:2]
        detail = median_footprint(make_surface(mesh, height, width), scene.cameras[scene.reference])
        rows, columns = self._bases[0].textures.shape[1:3] if self._bases else (height, width)
        self._set("finest", ONE_SAMPLE * max(detail, 1.0))
        self._set("finestEigen", ONE_SAMPLE * max(detail * np.sqrt(rows * columns / (height * width)), 1.0))
        extent = np.asarray(view.extent, np.float64)
        axes = np.divide([view.right, view.up], extent[:, None], out=np.zeros((2, 3)), where=extent[:, None] > 0)
        self._set("planeOrigin", view.origin - self._middle)
        self._set("planeNormal", np.cross(view.right, view.up))
        self._set("planeX", axes[0])
        self._set("planeY", axes[1])

    def _upload_bases(self) -> Any:
        """The texture array, four eigen textures to a texel, and the numbers that make values of what it stores."""
        if self.count == 0:
            return None
        height, width, channels = self._bases[0].textures.shape[1:]
        codes = all(basis.textures.dtype == np.uint8 for basis in self._bases)
        layers = int(channels) * self._groups
        dtype, stored, full = ("f1", np.uint8, 255) if codes else ("f4", np.float32, 1)
        array = self._keep(self.context.texture_array((width, height, layers), 4, dtype=dtype))
        scale, bias = np.zeros((2, layers, 4))
        texels = np.zeros((height, width, 4), stored)  # of one layer: more than that is never held
        owned = [(basis, own) for basis in self._bases for own in range(basis.count)]
        for layer in range(layers):
            group, channel = divmod(layer, channels)
            for part, (basis, own) in enumerate(owned[4 * group : 4 * group + 4]):
                texels[..., part] = basis.textures[own, ..., channel]
                scale[layer, part] = full * basis.scale[own, channel]
                bias[layer, part] = -float(basis.zero[own, channel]) * basis.scale[own, channel]
            array.write(texels, viewport=(0, 0, layer, width, height, 1))
        self._set("eigenScale", scale)
        self._set("eigenBias", bias)
        return _filtered(array)

    def _weight_maps(self) -> None:
        """Make the maps that fragments look weights up in, at the first frame that needs them."""
        if self._maps is not None or self.count == 0:
            return
        found = weight_map(self._scene, self._mode)
        nodes = len(found)
        layers = np.zeros((self._groups, 4, nodes, nodes), np.float32)
        layers.reshape(-1, nodes, nodes)[: self.count] = found.transpose(2, 0, 1)
        data = np.ascontiguousarray(layers.transpose(0, 2, 3, 1)).astype(np.float16)
        self._maps = self._keep(self.context.texture_array((nodes, nodes, self._groups), 4, data, dtype="f2"))
        self._maps.repeat_x = self._maps.repeat_y = False

    def _frames(self, width: int, height: int) -> tuple[Any, Any]:
        """The framebuffer to draw into and the one to read, of a size; kept until another is asked for."""
        if self._kept is None or self._kept[0] != (width, height):
            self._release_frames()
            context, size = self.context, (width, height)
            resolved = context.framebuffer([context.renderbuffer(size, 4)], context.depth_renderbuffer(size))
            drawn = resolved
            if self._multisample:
                samples = min(self._multisample, context.max_samples)
                drawn = context.framebuffer(
                    [context.renderbuffer(size, 4, samples=samples)],
                    context.depth_renderbuffer(size, samples=samples),
                )
            self._kept = (size, drawn, resolved)
        return self._kept[1], self._kept[2]

    def _release_frames(self) -> None:
        if self._kept is not None:
            for frame in {id(frame): frame for frame in self._kept[1:]}.values():
                for part in (*frame.color_attachments, frame.depth_attachment):
                    part.release()
                frame.release()
        self._kept = None

    def _keep(self, made: Any) -> Any:
        """What is to be given back in the end."""
        self._made.append(made)
        return made

    def _set(self, name: str, value: ArrayLike) -> None:
        """Write a uniform; one that the compiler found unused is absent."""
        if name in self._program:
            array = np.asarray(value)
            self._program[name].write(array.astype("i4" if array.dtype.kind in "ib" else "f4").tobytes())


def make_context() -> Any:
    """A moderngl context without a window. Raises OptionError (`opengl-missing`, `opengl-context`)."""
    try:
        import moderngl
    except ImportError as error:
        raise OptionError(
            "opengl-missing", "the OpenGL renderer needs moderngl", remedy="pip install 'eigenfield[gpu]'"
        ) from error
    problems = []
    options: tuple[dict[str, Any], ...] = ({"backend": "egl"}, {})  # without a display, else what the system has
    for option in options:
        try:
            return moderngl.create_standalone_context(require=VERSION, **option)
        except Exception as error:  # what backends raise is not documented, and no context is no bug of ours
            problems.append(str(error))
    raise OptionError(
        "opengl-context",
        f"no OpenGL 3.3 without a display here ({problems[0]})",
        remedy="install a GPU driver with EGL (Debian: libegl1 libgl1-mesa-dri), or use the software renderer",
    )


def _check_filter(filter: str) -> None:
    if filter not in FILTERS:
        raise OptionError("filter", f"no filter is called {filter!r}", remedy=f"use one of {', '.join(FILTERS)}")


def _checked_bases(scene: Scene) -> tuple[Basis, ...]:
    plane = scene.planes[0]
    channels = plane.mean.shape[2]
    sizes = {basis.textures.shape[1:] for basis in plane.bases if basis.count}
    if len(scene.planes) != 1 or channels not in (1, 3) or len(sizes) > 1:
        raise FormatError(
            "unsupported-layout",
            "OpenGL draws one plane of one or three channels, with eigen textures of one size",
            where="planes",
            remedy="use the software renderer",
        )
    return tuple(basis for basis in plane.bases if basis.count)


def _texture_of(mean: NDArray[np.float32]) -> tuple[tuple[int, int], int, bytes]:
    height, width, channels = mean.shape
    return (width, height), channels, np.ascontiguousarray(mean, np.float32).tobytes()


def _filtered(texture: Any) -> Any:
    """Mip maps and linear filters on a texture; its one channel stands for three."""
    import moderngl

    texture.repeat_x = texture.repeat_y = False
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)  # anisotropy: Mesa's blurs close up too
    if texture.components == 1:
        texture.swizzle = "RRR1"
    return texture


def _clip_matrix(camera: Camera, middle: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """(4, 4) from the world less `middle` to clip space; pixel rows run downwards, clip space's y upwards."""
    width, height = camera.width, camera.height
    view = np.hstack([camera.R, (camera.t + camera.R @ middle)[:, None]])
    distance = float(np.linalg.norm(view[:, 3]))
    far = distance + 1.01 * radius
    near = max(distance - 1.01 * radius, 1e-3 * far)
    picture = camera.K @ view
    depth = view[2]
    x = 2 / width * picture[0] - depth
    y = depth - 2 / height * picture[1]
    z = (far + near) / (far - near) * depth - np.array([0, 0, 0, 2 * far * near / (far - near)])
    return np.stack([x, y, z, depth])
