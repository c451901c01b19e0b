"""The OpenGL renderer: off screen on any GPU through EGL, with the shaders of the web viewer (equations 7 and 8)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.proxy import Sheets
from eigenfield.core.scene import Scene
from eigenfield.rendering.opengl.composer import GLSL_HEAD, Composer, set_uniforms, shader
from eigenfield.rendering.options import BLACK, TEXTURE_FILTERS, background_of, check_filter, check_textures
from eigenfield.rendering.picture import Picture, colour_changes, mixed_colour
from eigenfield.rendering.software.drawing import RENDER_ONE_SAMPLE_PX, make_surface, median_footprint
from eigenfield.rendering.weights import ViewWeights, view_weights

OPENGL_VERSION = 330  # OpenGL 3.3: texture arrays, and GLSL that reads as WebGL2's does

SURFACE_VERTEX_GLSL = """#version 330 core
uniform mat4 toClip;
in vec3 position;
in vec2 coordinate;
out vec2 uv;
void main() {
  uv = coordinate;
  gl_Position = toClip * vec4(position, 1.0);
}
"""
SURFACE_FRAGMENT_GLSL = "in vec2 uv;\nout vec4 colour;\nvoid main() { colour = vec4(surfaceColour(uv), 1.0); }\n"
SHEET_FRAGMENT_GLSL = "in vec2 uv;\nout vec4 colour;\nvoid main() { colour = sheetColour(uv); }\n"
WHOLE_VERTEX_GLSL = """#version 330 core
void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }
"""
OVER_FRAGMENT_GLSL = """#version 330 core
uniform sampler2D sheet;
out vec4 colour;
void main() { colour = texelFetch(sheet, ivec2(gl_FragCoord.xy), 0); }
"""


class OpenGLRenderer:
    """Draws a scene with OpenGL; used from the thread that made it, and closed (it is a context manager).

    Each viewpoint's texture is composed and then drawn (decision 15). Sheets are drawn back to front, each into a
    picture of its own: what is nearest there is blended once over the sheets behind, also where a sheet is folded.

    Attributes:
        context: The moderngl context; None: the renderer is closed.
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
        """Put a scene on the GPU.

        Args:
            filter: `bilinear` or `bicubic` (Catmull-Rom).
            weights: Mode of the weights that texels look up, one of `WEIGHT_MODES`.
            multisample: Samples of an edge pixel; 0: edges are not smoothed. Those of sheets never are.
            context: A moderngl context to draw in. Default: a new one.

        Raises:
            FormatError: `unsupported-layout`: the scene is no picture: neither one plane of one or three channels, nor
                planes with a matrix to R, G and B.
            OptionError: `opengl-missing`: moderngl is not installed; `opengl-context`: no driver, or one below OpenGL
                3.3; `opengl-memory`: the textures are too many or too large for it; `filter`.
        """
        check_filter(filter)
        self._scene = scene
        self._weights = weights
        self._changes = colour_changes(scene)
        self._composer: Composer | None = None
        self._multisample = multisample
        self._dtype = "f1" if scene.proxy.sheets is None else "f2"  # 8 bits are too few to blend sheets in
        self._owned = context is None
        self._kept: tuple[tuple[int, int], Any, Any, Any] | None = None
        self.context: Any = make_context() if context is None else context
        try:
            self._set_up(filter, weights)
        except Exception as error:
            self.close()
            if type(error).__module__.startswith("moderngl"):
                message = f"the textures of this scene do not fit the OpenGL driver: {error}"
                raise OptionError("opengl-memory", message, remedy="use the software renderer") from error
            raise

    @property
    def name(self) -> str:
        """The driver's name of what draws."""
        return str(self.context.info["GL_RENDERER"])

    def __enter__(self) -> OpenGLRenderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free everything on the GPU."""
        if self._composer is not None:
            self._composer.release()
        self._composer = None
        self._release_frames()
        if self._owned and self.context is not None:
            self.context.release()
        self.context = None

    def draw(
        self,
        camera: Camera,
        weights: ViewWeights | None = None,
        *,
        background: Sequence[float] = BLACK,
        textures: int | None = None,
        colour: NDArray[np.float32] | None = None,
    ) -> Picture:
        """A view, with values exact to 1 / 255.

        Args:
            weights: What is blended. Default: each point of the surface takes those of the place where its ray to
                the camera meets the view plane, which suits a camera anywhere; on the plane both are the same.

        Raises:
            OptionError: `textures`, `background`.
        """
        frame = self.paint(camera, weights, textures=textures, colour=colour)  # R, G and B are times coverage
        kept, full = (np.uint8, 255) if self._dtype == "f1" else (np.float16, 1)
        values = np.frombuffer(frame.read(components=4, dtype=self._dtype), kept)
        data = values.reshape(camera.height, camera.width, 4)[::-1].astype(np.float32) / np.float32(full)
        image, coverage = data[..., :3], np.ascontiguousarray(data[..., 3])
        image = image + (1 - coverage)[..., None] * background_of(background, 3)
        return Picture(np.ascontiguousarray(image), coverage)

    def paint(
        self,
        camera: Camera,
        weights: ViewWeights | None = None,
        *,
        textures: int | None = None,
        colour: NDArray[np.float32] | None = None,
    ) -> Any:
        """Draw R, G, B times coverage, and coverage, into a framebuffer, bottom row first.

        It stays on the GPU until the next call overwrites it. It has 8 bits, or halves if there are sheets.

        Raises:
            OptionError: `textures`.
        """
        check_textures(textures)
        assert self._composer is not None, "the renderer is closed"
        largest = max((basis.count for plane in self._scene.appearance.planes for basis in plane.bases), default=0)
        self._composer.compose(largest if textures is None else min(textures, largest), weights, camera.centre)
        drawn, resolved, alone = self._frames(camera.width, camera.height)
        if colour is None:
            colour = self._mixed_colour(camera, weights)
        gain, offset = (np.ones(3), np.zeros(3)) if colour is None else np.asarray(colour, np.float64)
        clip = _clip_matrix(camera, self._middle, self._radius)
        set_uniforms(self._program, toClip=clip.T, exposureScale=1 / gain, exposureBias=-offset / gain)
        drawn.use()
        drawn.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        self._composer.texture.use(0)
        if self._scene.proxy.sheets is None:
            self.context.enable_only(self.context.DEPTH_TEST)
            self._array.render()
        else:
            self._draw_sheets(drawn, alone, self._scene.proxy.sheets)
        if resolved is not drawn:
            self.context.copy_framebuffer(resolved, drawn)
        return resolved

    def _mixed_colour(self, camera: Camera, weights: ViewWeights | None) -> NDArray[np.float32] | None:
        """The exposure of a view; where points look up weights of their own, that of the camera's place."""
        if weights is None and self._changes is not None:
            x, y = self._scene.rig.view_plane.coordinates(camera.centre)[0]
            weights = view_weights(self._scene, (float(x), float(y)), self._weights)
        return None if weights is None else mixed_colour(self._changes, weights)

    def _draw_sheets(self, drawn: Any, alone: Any, sheets: Sheets) -> None:
        """Draw sheets over `drawn`, each into `alone` first."""
        context, first = self.context, 0
        context.blend_func = context.ONE, context.ONE_MINUS_SRC_ALPHA
        assert self._composer is not None
        for faces in sheets.faces:
            alone.use()
            alone.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            context.enable_only(context.DEPTH_TEST)
            self._composer.texture.use(0)
            self._array.render(vertices=3 * faces, first=3 * first)
            drawn.use()
            context.enable_only(context.BLEND)
            alone.color_attachments[0].use(0)
            self._over.render(context.TRIANGLES, vertices=3)
            first += faces

    def _set_up(self, filter: str, weights: str) -> None:
        context, scene, mesh = self.context, self._scene, self._scene.proxy.mesh
        self._composer = Composer(context, scene, weights)
        keep = self._composer.keep
        head = f"{GLSL_HEAD}#define BICUBIC {TEXTURE_FILTERS.index(filter)}\n"
        main = SURFACE_FRAGMENT_GLSL if scene.proxy.sheets is None else SHEET_FRAGMENT_GLSL
        source = head + shader("cubic") + shader("surface") + main
        self._program = keep(context.program(vertex_shader=SURFACE_VERTEX_GLSL, fragment_shader=source))
        # about the middle of the mesh: float32 keeps few digits where the world's origin is far away
        low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
        self._middle, self._radius = (low + high) / 2, float(np.linalg.norm(high - low) / 2) or 1.0
        assert mesh.uv is not None
        corners = np.concatenate([mesh.vertices - self._middle, mesh.uv], axis=1).astype(np.float32)
        vertices = keep(context.buffer(corners.tobytes()))
        faces = keep(context.buffer(np.ascontiguousarray(mesh.faces, np.int32).tobytes()))
        layout = [(vertices, "3f 2f", "position", "coordinate")]
        self._array = keep(context.vertex_array(self._program, layout, index_buffer=faces))
        over = keep(context.program(vertex_shader=WHOLE_VERTEX_GLSL, fragment_shader=OVER_FRAGMENT_GLSL))
        self._over = keep(context.vertex_array(over, []))
        detail = median_footprint(make_surface(mesh, *scene.appearance.atlas), scene.rig.cameras[scene.rig.reference])
        set_uniforms(self._program, composed=np.int32(0), finest=RENDER_ONE_SAMPLE_PX * max(detail, 1.0))

    def _frames(self, width: int, height: int) -> tuple[Any, Any, Any]:
        """The framebuffer to draw into, the one to read, and, if there are sheets, that of one of them, of a size; kept
        until another is asked for."""
        if self._kept is None or self._kept[0] != (width, height):
            self._release_frames()
            context, size = self.context, (width, height)
            values = context.renderbuffer(size, 4, dtype=self._dtype)
            drawn = resolved = alone = context.framebuffer([values], context.depth_renderbuffer(size))
            if self._dtype == "f2":
                sheet = context.texture(size, 4, dtype=self._dtype)
                alone = context.framebuffer([sheet], context.depth_renderbuffer(size))
            elif self._multisample:
                samples = min(self._multisample, context.max_samples)
                depth = context.depth_renderbuffer(size, samples=samples)
                drawn = context.framebuffer([context.renderbuffer(size, 4, samples=samples)], depth)
            self._kept = (size, drawn, resolved, alone)
        return self._kept[1:]

    def _release_frames(self) -> None:
        if self._kept is not None:
            for frame in {id(frame): frame for frame in self._kept[1:]}.values():
                for part in (*frame.color_attachments, frame.depth_attachment):
                    part.release()
                frame.release()
        self._kept = None


def make_context() -> Any:
    """A moderngl context without a window.

    Raises:
        OptionError: `opengl-missing`, `opengl-context`.
    """
    try:
        import moderngl
    except ImportError as error:
        message, remedy = "the OpenGL renderer needs moderngl", "pip install 'eigenfield[gpu]'"
        raise OptionError("opengl-missing", message, remedy=remedy) from error
    problems = []
    options: tuple[dict[str, Any], ...] = ({"backend": "egl"}, {})  # without a display, else what the system has
    for option in options:
        try:
            return moderngl.create_standalone_context(require=OPENGL_VERSION, **option)
        except Exception as error:  # what backends raise is not documented, and no context is no bug of ours
            problems.append(str(error))
    remedy = "install a GPU driver with EGL (Debian: libegl1 libgl1-mesa-dri), or use the software renderer"
    raise OptionError("opengl-context", f"no OpenGL 3.3 without a display here ({problems[0]})", remedy=remedy)


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
