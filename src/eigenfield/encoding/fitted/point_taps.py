"""Catmull-Rom reads and writes of planar textures at single points, in LLVM's intermediate representation.

A point's column and row are two lanes of one vector, and the filter's four weights along an axis are four: numba
compiles without LLVM's pass that joins neighbouring scalars (SLP), and would work on each of them in turn. Terms are
added in one order on every machine, since the results go into files.

Each function tells whether all taps of the point are inside its textures. Where they are not, it does nothing: borders
are rare, and `kernels` has loops for them.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call,untyped-decorator,misc,import-untyped"

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from eigenfield.imaging.texels import splat

TAPS = 4
# Weights of the tap before a point's texel, at it, and one and two after it, by powers of the distance from it.
CATMULL_ROM = ((0.0, 1.0, 0.0, 0.0), (-0.5, 0.0, 0.5, 0.0), (1.0, -2.5, 2.0, -0.5), (-0.5, 1.5, -1.5, 0.5))
_WHOLE, _NUMBER, _LONG = ir.IntType(32), ir.FloatType(), ir.IntType(64)
_PAIR, _WHOLE_PAIR = ir.VectorType(_NUMBER, 2), ir.VectorType(_WHOLE, 2)
_FOUR = ir.VectorType(_NUMBER, TAPS)


def _lane(builder, vector, number):
    return builder.extract_element(vector, ir.Constant(_WHOLE, number))


def _pair(builder, one, other):
    """A vector of two numbers."""
    vector = ir.Constant(ir.VectorType(one.type, 2), ir.Undefined)
    for number, value in enumerate((one, other)):
        vector = builder.insert_element(vector, value, ir.Constant(_WHOLE, number))
    return vector


def _weights(builder, distance):
    """The four weights at a distance, a vector."""
    along = splat(builder, distance, _FOUR)
    constants = [ir.Constant(_FOUR, list(numbers)) for numbers in CATMULL_ROM]
    total = constants[-1]
    for constant in constants[-2::-1]:
        total = builder.fadd(builder.fmul(total, along), constant)
    return total


class _Taps:
    """The taps of a point in one texture.

    Attributes:
        inside: Whether all of them are in it.
        channels: Of the texture, int64.
    """

    def __init__(self, builder, texture, shape, points, at, ratio):
        self.builder, self.texture = builder, texture
        self.channels, height, self.width = cgutils.unpack_tuple(builder, shape)
        self.plane = builder.mul(height, self.width)
        down, across = cgutils.unpack_tuple(builder, ratio)
        place = builder.bitcast(builder.gep(points, [builder.shl(at, _LONG(1))]), _PAIR.as_pointer())
        half, zero, one = (ir.Constant(_PAIR, [value] * 2) for value in (0.5, 0.0, 1.0))
        point = builder.fadd(builder.load(place, align=4), half)
        point = builder.fsub(builder.fmul(point, _pair(builder, across, down)), half)
        point = builder.select(builder.fcmp_ordered(">", point, zero), point, zero)
        sides = builder.trunc(_pair(builder, self.width, height), _WHOLE_PAIR)
        last = builder.fsub(builder.sitofp(sides, _PAIR), one)
        point = builder.select(builder.fcmp_ordered("<", point, last), point, last)
        texel = builder.fptosi(point, _WHOLE_PAIR)
        rest = builder.fsub(point, builder.sitofp(texel, _PAIR))
        start = builder.sub(texel, ir.Constant(_WHOLE_PAIR, [1, 1]))
        room, none = builder.sub(sides, ir.Constant(_WHOLE_PAIR, [TAPS - 1] * 2)), ir.Constant(_WHOLE_PAIR, [0, 0])
        room = builder.select(builder.icmp_signed(">", room, none), room, none)
        fits = builder.icmp_unsigned("<", start, room)
        self.inside = builder.and_(_lane(builder, fits, 0), _lane(builder, fits, 1))
        column, row = (builder.sext(_lane(builder, start, i), _LONG) for i in range(2))
        self._first = builder.add(builder.mul(row, self.width), column)
        self._across, vertical = (_weights(builder, _lane(builder, rest, i)) for i in range(2))
        self._down = [splat(builder, _lane(builder, vertical, i), _FOUR) for i in range(TAPS)]

    def _rows(self, texture, channel):
        """The four texels of each row in a channel, a pointer and their weight along columns each."""
        place = self.builder.add(self._first, self.builder.mul(channel, self.plane))
        for weight in self._down:
            yield self.builder.bitcast(self.builder.gep(texture, [place]), _FOUR.as_pointer()), weight
            place = self.builder.add(place, self.width)

    def read(self, channel):
        """What the point shows of a channel."""
        build = self.builder
        rows = [build.fmul(build.load(at, align=4), weight) for at, weight in self._rows(self.texture, channel)]
        total = build.fadd(build.fadd(rows[0], rows[1]), build.fadd(rows[2], rows[3]))
        total = build.fmul(total, self._across)
        halves = [
            build.shuffle_vector(total, total, ir.Constant(ir.VectorType(_WHOLE, 2), [i, i + 1])) for i in (0, 2)
        ]  # fmt: skip
        both = build.fadd(*halves)
        return build.fadd(_lane(build, both, 0), _lane(build, both, 1))

    def make_absolute(self):
        """From here on weights count without their signs."""
        kind = ir.FunctionType(_FOUR, [_FOUR])
        absolute = cgutils.get_or_insert_function(self.builder.module, kind, f"llvm.fabs.v{TAPS}f32")
        self._across, *self._down = (self.builder.call(absolute, [each]) for each in (self._across, *self._down))

    def add(self, texture, channel, value):
        """The transpose of `read`: value goes to the texels of another texture of the same shape."""
        build = self.builder
        share = build.fmul(self._across, splat(build, value, _FOUR))
        for at, weight in self._rows(texture, channel):
            build.store(build.fadd(build.load(at, align=4), build.fmul(share, weight)), at, align=4)


def _pointers(context, builder, signature, arguments, positions):
    """Where the numbers of some arrays among the arguments begin."""
    return [context.make_array(signature.args[i])(context, builder, arguments[i]).data for i in positions]


_SHAPE, _RATIO = types.UniTuple(types.int64, 3), types.UniTuple(types.float32, 2)


def _signature(texture, points, image):
    """Of `draw_point` and its transpose."""
    count = types.int64
    return types.boolean(texture, _SHAPE, _RATIO, points, count, types.float32, image, count, count)


def _each_channel(act):
    """The body of `draw_point` or its transpose: `act` is given each channel and where the pixel's value of it is."""

    def generate(context, builder, signature, arguments):
        texture, points, image = _pointers(context, builder, signature, arguments, (0, 3, 6))
        shape, ratio, at, part, area, pixel = (arguments[i] for i in (1, 2, 4, 5, 7, 8))
        taps = _Taps(builder, texture, shape, points, at, ratio)
        with builder.if_then(taps.inside, likely=True), cgutils.for_range(builder, taps.channels, intp=_LONG) as loop:
            value = builder.gep(image, [builder.add(pixel, builder.mul(loop.index, area))])
            act(builder, taps, loop.index, part, value)
        return taps.inside

    return generate


@intrinsic
def draw_point(typing_context, texture, shape, ratio, points, at, part, image, area, pixel):
    """image[k area + pixel] += part times what the point shows of channel k.

    Args:
        texture: Flat float32 array.
        shape: Its channels, rows and columns.
        ratio: Its rows, and its columns, for one of the finest atlas; float32.
        points: Flat float32 array of columns and rows in the finest atlas.
        at: Number of the point.
        part: float32.
        image: Flat float32 array.
        area: Pixels of a channel.
        pixel: Number of the pixel.
    """

    def draw(builder, taps, channel, part, value):
        builder.store(
            builder.fadd(builder.load(value, align=4), builder.fmul(part, taps.read(channel))), value, align=4
        )

    return _signature(texture, points, image), _each_channel(draw)


@intrinsic
def return_point(typing_context, texture, shape, ratio, points, at, part, image, area, pixel):
    """The transpose of `draw_point`: part times image[k area + pixel] goes to the texels of channel k that the point
    shows."""

    def give_back(builder, taps, channel, part, value):
        taps.add(taps.texture, channel, builder.fmul(part, builder.load(value, align=4)))

    return _signature(texture, points, image), _each_channel(give_back)


@intrinsic
def multiply_point(typing_context, texture, product, shape, ratio, points, at, part):
    """part times what the point shows of each channel of a texture goes to the same texels of the product."""

    def generate(context, builder, signature, arguments):
        texture, product, points = _pointers(context, builder, signature, arguments, (0, 1, 4))
        shape, ratio, at, part = (arguments[i] for i in (2, 3, 5, 6))
        taps = _Taps(builder, texture, shape, points, at, ratio)
        with builder.if_then(taps.inside, likely=True), cgutils.for_range(builder, taps.channels, intp=_LONG) as loop:
            taps.add(product, loop.index, builder.fmul(part, taps.read(loop.index)))
        return taps.inside

    return types.boolean(texture, product, _SHAPE, _RATIO, points, types.int64, types.float32), generate


@intrinsic
def multiply_point_twice(
    typing_context, fine, fine_product, fine_shape, fine_ratio, coarse, coarse_product, coarse_shape, coarse_ratio,
    points, at, part,
):  # fmt: skip
    """As `multiply_point`, of what the point shows of two textures together, which goes to the texels of both."""

    def generate(context, builder, signature, arguments):
        fine, fine_product, coarse, coarse_product, points = _pointers(
            context, builder, signature, arguments, (0, 1, 4, 5, 8)
        )
        at, part = arguments[9:]
        one = _Taps(builder, fine, arguments[2], points, at, arguments[3])
        other = _Taps(builder, coarse, arguments[6], points, at, arguments[7])
        inside = builder.and_(one.inside, other.inside)
        with builder.if_then(inside, likely=True), cgutils.for_range(builder, one.channels, intp=_LONG) as loop:
            value = builder.fmul(part, builder.fadd(one.read(loop.index), other.read(loop.index)))
            one.add(fine_product, loop.index, value)
            other.add(coarse_product, loop.index, value)
        return inside

    textures = fine, fine_product, _SHAPE, _RATIO, coarse, coarse_product, _SHAPE, _RATIO
    return types.boolean(*textures, points, types.int64, types.float32), generate


@intrinsic
def return_two(typing_context, one, other, shape, ratio, points, at, value, size):
    """As `return_point`: a value goes to the texels of one texture, and a size, by weights without their signs, to
    those of another.

    Args:
        one, other: Flat float32 arrays of one channel.
        value, size: float32.
    """

    def generate(context, builder, signature, arguments):
        one, other, points = _pointers(context, builder, signature, arguments, (0, 1, 4))
        shape, ratio, at, value, size = (arguments[i] for i in (2, 3, 5, 6, 7))
        taps = _Taps(builder, one, shape, points, at, ratio)
        with builder.if_then(taps.inside, likely=True):
            taps.add(one, _LONG(0), value)
            taps.make_absolute()
            taps.add(other, _LONG(0), size)
        return taps.inside

    number = types.float32
    return types.boolean(one, other, _SHAPE, _RATIO, points, types.int64, number, number), generate
