"""Vectors and prefetching, which numba has no words for, in LLVM's intermediate representation.

numba compiles without LLVM's pass that joins neighbouring scalars (SLP), so a filter written with three channels by
hand stays three scalar sums, and a short loop with a condition stays a loop. Here lanes are stated; LLVM maps them to
what the processor has.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call,untyped-decorator,misc,import-untyped"

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from eigenfield.imaging.texels import TEXEL_LANES, splat

EDGE_SAMPLES = 4  # of an edge pixel
LANE_PX = 8  # drawn at once
PRODUCT_LANES = 16  # of a matrix's row
FASTMATH_FLAGS = ("fast",)


@intrinsic
def blend_texels(typing_context, texture, rows, columns, down, across):
    """sum_v down[v] sum_u across[u] texture[rows[v] + columns[u]: + 4], as a tuple of four float32.

    Nothing is checked: the caller has clamped the addresses.

    Args:
        texture: Flat float32 array.
        rows, columns: Tuples of int32, not negative.
        down, across: Tuples of float32.
    """
    result = types.UniTuple(types.float32, TEXEL_LANES)

    def generate(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        vector, whole = ir.VectorType(ir.FloatType(), TEXEL_LANES), ir.IntType(64)
        rows, columns, down, across = (
            [builder.extract_value(value, i) for i in range(kind.count)]
            for value, kind in zip(arguments[1:], signature.args[1:], strict=True)
        )

        def weighted_sum(terms, weights):
            products = [
                builder.fmul(term, weight, flags=FASTMATH_FLAGS) for term, weight in zip(terms, weights, strict=True)
            ]
            total = products[0]
            for product in products[1:]:
                total = builder.fadd(total, product, flags=FASTMATH_FLAGS)
            return total

        def texel(row, column):
            pointer = builder.gep(row, [builder.zext(column, whole)])
            return builder.load(builder.bitcast(pointer, vector.as_pointer()), align=4)

        horizontal, vertical = ([splat(builder, weight, vector) for weight in of] for of in (across, down))
        starts = [builder.gep(data, [builder.zext(row, whole)]) for row in rows]  # so that no texel's address is summed
        lines = [weighted_sum([texel(row, column) for column in columns], horizontal) for row in starts]
        total = weighted_sum(lines, vertical)
        lanes = [builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(TEXEL_LANES)]
        return context.make_tuple(builder, signature.return_type, lanes)

    return result(texture, rows, columns, down, across), generate


@intrinsic
def add_texel(typing_context, sums, at, part, texel):
    """sums[at: at + 4] += part * texel.

    Args:
        sums: Flat float32 array.
        at: Address, int64.
        part: float32.
        texel: Tuple of four float32.
    """

    def generate(context, builder, signature, arguments):
        vector, index = ir.VectorType(ir.FloatType(), TEXEL_LANES), ir.IntType(32)
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        place = builder.bitcast(builder.gep(data, [arguments[1]]), vector.as_pointer())
        values = ir.Constant(vector, ir.Undefined)
        for i in range(TEXEL_LANES):
            values = builder.insert_element(values, builder.extract_value(arguments[3], i), ir.Constant(index, i))
        share = builder.fmul(splat(builder, arguments[2], vector), values, flags=FASTMATH_FLAGS)
        builder.store(builder.fadd(builder.load(place, align=4), share, flags=FASTMATH_FLAGS), place, align=4)
        return context.get_dummy_value()

    return types.none(sums, types.int64, part, texel), generate


@intrinsic
def fetch_early(typing_context, texture, address):
    """Prefetch texture[address] into the cache.

    Args:
        texture: Flat.
        address: int32.
    """

    def generate(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        pointer = builder.gep(data, [builder.zext(arguments[1], ir.IntType(64))])
        pointer = builder.bitcast(pointer, ir.IntType(8).as_pointer())
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [pointer.type, number, number, number])
        prefetch = builder.module.declare_intrinsic("llvm.prefetch", [pointer.type], kind)
        builder.call(prefetch, [pointer, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.none(texture, types.int32), generate


@intrinsic
def draw_lanes(typing_context, nearest, first, second, at, count, near, near_step, one, one_step, two, two_step):
    """Draw `count` pixels of a row, at most eight; returns whether any of them was drawn.

    Where near + i near_step > nearest[at + i], that becomes nearest, and one + i one_step and two + i two_step go into
    `first` and `second`. The other pixels of the eight are written back as they were.

    Args:
        nearest, first, second: Flat float32 arrays with room for eight pixels from `at` on.
        at: First pixel.
        count: Number of pixels.
        near, near_step, one, one_step, two, two_step: float32.
    """

    def generate(context, builder, signature, arguments):
        vector, whole = ir.VectorType(ir.FloatType(), LANE_PX), ir.VectorType(ir.IntType(32), LANE_PX)

        def pointer(position):
            data = context.make_array(signature.args[position])(context, builder, arguments[position]).data
            return builder.bitcast(builder.gep(data, [arguments[3]]), vector.as_pointer())

        steps = ir.Constant(vector, [float(i) for i in range(LANE_PX)])

        def along(position):
            product = builder.fmul(steps, splat(builder, arguments[position + 1], vector), flags=FASTMATH_FLAGS)
            return builder.fadd(splat(builder, arguments[position], vector), product, flags=FASTMATH_FLAGS)

        place, depth = pointer(0), along(5)
        before = builder.load(place, align=4)
        meant = builder.icmp_signed("<", ir.Constant(whole, list(range(LANE_PX))), splat(builder, arguments[4], whole))
        drawn = builder.and_(meant, builder.fcmp_ordered(">", depth, before))
        builder.store(builder.select(drawn, depth, before), place, align=4)
        for array, value in ((1, along(7)), (2, along(9))):
            place = pointer(array)
            builder.store(builder.select(drawn, value, builder.load(place, align=4)), place, align=4)
        return builder.icmp_unsigned(
            "!=", builder.bitcast(drawn, ir.IntType(LANE_PX)), ir.Constant(ir.IntType(LANE_PX), 0)
        )

    number = types.float32
    return types.boolean(nearest, first, second, types.intp, types.int32, *[number] * 6), generate


@intrinsic
def draw_four(typing_context, samples, at, more, a, b, c, slack, u, v):
    """Draw a triangle into the four samples of a pixel; returns whether any of them was drawn.

    As in `imaging.raster.draw_band` the first of equally near triangles stays, and terms are added in one order on
    every machine.

    Args:
        samples: Flat float32, from `at` on four of 1 / depth, then of two texture coordinates over depth.
        at: First number of the pixel.
        more: Flat float64, what is added to each edge function in the four samples, a's first.
        a, b, c: The edge functions in the pixel's middle.
        slack: As of `draw_band`.
        u, v: Tuples of three float64, texture coordinates at the corners.
    """

    def generate(context, builder, signature, arguments):
        double, single = ir.VectorType(ir.DoubleType(), EDGE_SAMPLES), ir.VectorType(ir.FloatType(), EDGE_SAMPLES)
        whole, bits = ir.IntType(64), ir.IntType(EDGE_SAMPLES)
        data, offsets = (
            context.make_array(signature.args[i])(context, builder, arguments[i]).data for i in (0, 2)
        )  # fmt: skip

        def four(pointer, place, kind):
            return builder.bitcast(builder.gep(pointer, [place]), kind.as_pointer())

        def add_in_order(terms):
            return builder.fadd(builder.fadd(terms[0], terms[1]), terms[2])

        here = []
        for i, value in enumerate(arguments[3:6]):
            more = builder.load(four(offsets, whole(EDGE_SAMPLES * i), double), align=8)
            here.append(builder.fadd(splat(builder, value, double), more))
        depth = add_in_order(here)
        least = builder.fmul(splat(builder, builder.fneg(arguments[6]), double), depth)
        places = [four(data, builder.add(arguments[1], whole(EDGE_SAMPLES * part)), single) for part in range(3)]
        near, before = builder.fptrunc(depth, single), builder.load(places[0], align=4)
        drawn = builder.fcmp_ordered(">", near, before)
        for value in here:
            drawn = builder.and_(drawn, builder.fcmp_ordered(">=", value, least))
        builder.store(builder.select(drawn, near, before), places[0], align=4)
        for place, corners in zip(places[1:], arguments[7:], strict=True):
            ends = [splat(builder, builder.extract_value(corners, i), double) for i in range(3)]
            value = add_in_order([builder.fmul(weight, end) for weight, end in zip(here, ends, strict=True)])
            kept = builder.load(place, align=4)
            builder.store(builder.select(drawn, builder.fptrunc(value, single), kept), place, align=4)
        return builder.icmp_unsigned("!=", builder.bitcast(drawn, bits), ir.Constant(bits, 0))

    real = types.float64
    return types.boolean(samples, types.intp, more, real, real, real, real, u, v), generate


@intrinsic
def add_row_of_product(typing_context, row, first, count, matrix, at, out, place):
    """out[place: + 16] += sum_i row[first + i] matrix[at + 16 i: + 16], one fused addition after the other.

    Nothing is checked.

    Args:
        row: Flat float32 array.
        first: Address of its first number, int64.
        count: Numbers of the row, int64.
        matrix: Flat float32 array.
        at: Address of the matrix, int64.
        out: Flat float32 array that is neither of the others.
        place: Address in it, int64.
    """

    def generate(context, builder, signature, arguments):
        vector, whole, align = ir.VectorType(ir.FloatType(), PRODUCT_LANES), ir.IntType(64), 4
        row, matrix, out = (
            context.make_array(signature.args[i])(context, builder, arguments[i]).data for i in (0, 3, 5)
        )  # fmt: skip
        kind = ir.FunctionType(vector, [vector] * 3)
        multiply_add = cgutils.get_or_insert_function(builder.module, kind, f"llvm.fmuladd.v{PRODUCT_LANES}f32")
        goal = builder.bitcast(builder.gep(out, [arguments[6]]), vector.as_pointer())
        total = cgutils.alloca_once_value(builder, builder.load(goal, align=align))
        with cgutils.for_range(builder, arguments[2], intp=whole) as loop:
            number = builder.load(builder.gep(row, [builder.add(arguments[1], loop.index)]), align=align)
            place = builder.add(arguments[4], builder.mul(loop.index, whole(PRODUCT_LANES)))
            line = builder.load(builder.bitcast(builder.gep(matrix, [place]), vector.as_pointer()), align=align)
            sum_ = builder.call(multiply_add, [splat(builder, number, vector), line, builder.load(total)])
            builder.store(sum_, total)
        builder.store(builder.load(total), goal, align=align)
        return context.get_dummy_value()

    number = types.int64
    return types.none(row, number, number, matrix, number, out, number), generate
