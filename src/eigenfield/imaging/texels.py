"""Bilinear reads and writes of texels with four channels, in LLVM's intermediate representation.

numba compiles without LLVM's pass that joins neighbouring scalars (SLP): four channels written by hand stay four scalar
sums. Here the four channels are one vector.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call,untyped-decorator,misc,import-untyped"

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

TEXEL_LANES = 4


def splat(builder, scalar, kind):
    """A vector of `kind` with a number in all its lanes."""
    index = ir.IntType(32)
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), scalar, ir.Constant(index, 0))
    return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(index, kind.count), [0] * kind.count))


def _texel_pointer(context, builder, kind, array, place):
    """Pointer to the four numbers of a flat array from `place` on."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [place]), ir.VectorType(ir.FloatType(), TEXEL_LANES).as_pointer())


def _square_of_texels(context, builder, kinds, arguments):
    """Pointers to the four texels of a bilinear read, and their weights as vectors."""
    vector, lanes = ir.VectorType(ir.FloatType(), TEXEL_LANES), ir.Constant(ir.IntType(64), TEXEL_LANES)
    array, first, line, right, below = arguments[:5]
    one = ir.Constant(ir.FloatType(), 1)
    both = builder.fmul(right, below)
    above, left = builder.fsub(right, both), builder.fsub(below, both)
    weights = [builder.fsub(builder.fsub(one, right), left), above, left, both]
    under = builder.add(first, line)
    places = [first, builder.add(first, lanes), under, builder.add(under, lanes)]
    pointers = [_texel_pointer(context, builder, kinds[0], array, place) for place in places]
    return pointers, [splat(builder, weight, vector) for weight in weights]


@intrinsic
def gather_bilinear(typing_context, texels, first, line, right, below, out, at):
    """out[at: at + 4] = the bilinear value of four channels of flat float32 arrays. Nothing is checked.

    Terms are added in one order on every machine, since the results go into files.

    Args:
        first: Address of the texel left above.
        line: Distance of rows.
        right, below: Float32, how far the place lies right of and below that texel, 0 to 1.
    """

    def generate(context, builder, signature, arguments):
        pointers, weights = _square_of_texels(context, builder, signature.args, arguments)
        terms = [builder.fmul(builder.load(p, align=4), w) for p, w in zip(pointers, weights, strict=True)]
        total = builder.fadd(builder.fadd(terms[0], terms[1]), builder.fadd(terms[2], terms[3]))
        builder.store(total, _texel_pointer(context, builder, signature.args[5], arguments[5], arguments[6]), align=4)
        return context.get_dummy_value()

    return types.void(texels, first, line, right, below, out, at), generate


@intrinsic
def scatter_bilinear(typing_context, texels, first, line, right, below, values, at):
    """The transpose of `gather_bilinear`: adds values[at: at + 4] to four texels."""

    def generate(context, builder, signature, arguments):
        pointers, weights = _square_of_texels(context, builder, signature.args, arguments)
        source = _texel_pointer(context, builder, signature.args[5], arguments[5], arguments[6])
        value = builder.load(source, align=4)
        for pointer, weight in zip(pointers, weights, strict=True):
            builder.store(builder.fadd(builder.load(pointer, align=4), builder.fmul(value, weight)), pointer, align=4)
        return context.get_dummy_value()

    return types.void(texels, first, line, right, below, values, at), generate


@intrinsic
def bilinear_slopes(typing_context, texels, first, line, right, below, values, at):
    """The scalar products of values[at: at + 4] with the slopes of a bilinear read, across and down, as two float32."""
    result = types.UniTuple(types.float32, 2)

    def generate(context, builder, signature, arguments):
        vector, index = ir.VectorType(ir.FloatType(), TEXEL_LANES), ir.IntType(32)
        pointers, _ = _square_of_texels(context, builder, signature.args, arguments)
        a, b, c, d = (builder.load(pointer, align=4) for pointer in pointers)
        source = _texel_pointer(context, builder, signature.args[5], arguments[5], arguments[6])
        value = builder.load(source, align=4)
        above, under, left, beside = (builder.fsub(*pair) for pair in ((b, a), (d, c), (c, a), (d, b)))

        def product(one, other, part):
            between = builder.fmul(builder.fsub(other, one), splat(builder, part, vector))
            terms = builder.fmul(value, builder.fadd(one, between))
            lanes = [builder.extract_element(terms, ir.Constant(index, i)) for i in range(TEXEL_LANES)]
            return builder.fadd(builder.fadd(lanes[0], lanes[1]), builder.fadd(lanes[2], lanes[3]))

        across, down = product(above, under, arguments[4]), product(left, beside, arguments[3])
        return context.make_tuple(builder, signature.return_type, [across, down])

    return result(texels, first, line, right, below, values, at), generate


@intrinsic
def add_scaled_texel(typing_context, out, at, part, values, place):
    """out[at: at + 4] += part * values[place: place + 4], of flat float32 arrays."""

    def generate(context, builder, signature, arguments):
        vector = ir.VectorType(ir.FloatType(), TEXEL_LANES)
        goal = _texel_pointer(context, builder, signature.args[0], arguments[0], arguments[1])
        source = _texel_pointer(context, builder, signature.args[3], arguments[3], arguments[4])
        share = builder.fmul(splat(builder, arguments[2], vector), builder.load(source, align=4))
        builder.store(builder.fadd(builder.load(goal, align=4), share), goal, align=4)
        return context.get_dummy_value()

    return types.void(out, at, part, values, place), generate
