"""What numba cannot say, written in the compiler's own language: vectors and prefetching, on any processor.

numba compiles without LLVM's pass that joins neighbouring scalars (SLP), so a filter written with three channels by
hand stays three scalar sums, and a short loop with a condition stays a loop. Here lanes are stated; LLVM maps them to
what the processor has.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call,untyped-decorator,misc,import-untyped"

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

LANES = 4  # of a texel
RUN = 8  # pixels drawn at once
FAST = ("fast",)


@intrinsic
def blend_texels(typing_context, texture, rows, columns, down, across):
    """sum_v down[v] sum_u across[u] texture[rows[v] + columns[u]: + 4], as a tuple of four float32.

    texture: flat float32 array. rows, columns: tuples of int32, not negative. down, across: tuples of float32. Nothing
    is checked: whoever calls has clamped the addresses.
    """
    result = types.UniTuple(types.float32, LANES)

    def generate(context, builder, signature, arguments):
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        vector, whole = ir.VectorType(ir.FloatType(), LANES), ir.IntType(64)
        rows, columns, down, across = (
            [builder.extract_value(value, i) for i in range(kind.count)]
            for value, kind in zip(arguments[1:], signature.args[1:], strict=True)
        )

        def repeated(scalar):
            first = builder.insert_element(ir.Constant(vector, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0))
            return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))

        def weighted(terms, weights):
            products = [builder.fmul(term, weight, flags=FAST) for term, weight in zip(terms, weights, strict=True)]
            total = products[0]
            for product in products[1:]:
                total = builder.fadd(total, product, flags=FAST)
            return total

        def texel(row, column):
            pointer = builder.gep(data, [builder.zext(builder.add(row, column), whole)])
            return builder.load(builder.bitcast(pointer, vector.as_pointer()), align=4)

        horizontal, vertical = [repeated(weight) for weight in across], [repeated(weight) for weight in down]
        lines = [weighted([texel(row, column) for column in columns], horizontal) for row in rows]
        total = weighted(lines, vertical)
        lanes = [builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(LANES)]
        return context.make_tuple(builder, signature.return_type, lanes)

    return result(texture, rows, columns, down, across), generate


def _square_of_taps(context, builder, signature, arguments):
    """What both cubic intrinsics need: four pointers to a row's four texels each, their weights across as a vector,
    weights down as vectors of one number each, and how to make such."""
    vector, index = ir.VectorType(ir.FloatType(), LANES), ir.IntType(32)
    data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
    place, line, across, down = arguments[1:5]

    def repeated(scalar):
        lane = builder.insert_element(ir.Constant(vector, ir.Undefined), scalar, ir.Constant(index, 0))
        return builder.shuffle_vector(lane, lane, ir.Constant(ir.VectorType(index, LANES), [0] * LANES))

    horizontal = ir.Constant(vector, ir.Undefined)
    for i in range(LANES):
        scalar = builder.extract_value(across, i)
        horizontal = builder.insert_element(horizontal, scalar, ir.Constant(index, i))
    pointers = []
    for _ in range(LANES):
        pointers.append(builder.bitcast(builder.gep(data, [place]), vector.as_pointer()))
        place = builder.add(place, line)
    return pointers, horizontal, [repeated(builder.extract_value(down, i)) for i in range(LANES)], repeated


@intrinsic
def take_cubic(typing_context, texture, first, line, across, down):
    """sum_v down[v] sum_u across[u] texture[first + v line + u], float32, u and v from 0 to 3.

    texture: flat float32 array. across, down: tuples of four float32. Nothing is checked. Sums in this order on every
    machine: a fit's results go into files.
    """

    def generate(context, builder, signature, arguments):
        pointers, horizontal, vertical, _ = _square_of_taps(context, builder, signature, arguments)
        rows = [builder.fmul(builder.load(p, align=4), w) for p, w in zip(pointers, vertical, strict=True)]
        total = builder.fadd(builder.fadd(rows[0], rows[1]), builder.fadd(rows[2], rows[3]))
        total = builder.fmul(total, horizontal)
        lanes = [builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(LANES)]
        return builder.fadd(builder.fadd(lanes[0], lanes[1]), builder.fadd(lanes[2], lanes[3]))

    return types.float32(texture, first, line, across, down), generate


@intrinsic
def give_cubic(typing_context, texture, first, line, across, down, value):
    """The transpose of `take_cubic`: texture[first + v line + u] += down[v] across[u] value."""

    def generate(context, builder, signature, arguments):
        pointers, horizontal, vertical, repeated = _square_of_taps(context, builder, signature, arguments)
        share = builder.fmul(horizontal, repeated(arguments[5]))
        for pointer, weight in zip(pointers, vertical, strict=True):
            found = builder.fadd(builder.load(pointer, align=4), builder.fmul(share, weight))
            builder.store(found, pointer, align=4)
        return context.get_dummy_value()

    return types.none(texture, first, line, across, down, value), generate


@intrinsic
def fetch_early(typing_context, texture, address):
    """Ask for texture[address] to be in the cache soon; no more than a hint. texture: flat; address: int32."""

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
    """Eight pixels of a row from `at` on, of which the first `count` are meant; whether any of them was drawn.

    Where near + i near_step > nearest[at + i], that becomes nearest and one + i one_step, two + i two_step go into
    `first` and `second`, all flat float32 arrays with room for eight; what is not meant is written back as it was.
    """

    def generate(context, builder, signature, arguments):
        vector, mask = ir.VectorType(ir.FloatType(), RUN), ir.VectorType(ir.IntType(32), RUN)
        index = ir.IntType(32)

        def repeated(scalar, kind):
            lane = builder.insert_element(ir.Constant(kind, ir.Undefined), scalar, ir.Constant(index, 0))
            return builder.shuffle_vector(lane, lane, ir.Constant(mask, [0] * RUN))

        def pointer(position):
            data = context.make_array(signature.args[position])(context, builder, arguments[position]).data
            return builder.bitcast(builder.gep(data, [arguments[3]]), vector.as_pointer())

        steps = ir.Constant(vector, [float(i) for i in range(RUN)])

        def along(position):
            product = builder.fmul(steps, repeated(arguments[position + 1], vector), flags=FAST)
            return builder.fadd(repeated(arguments[position], vector), product, flags=FAST)

        place, depth = pointer(0), along(5)
        before = builder.load(place, align=4)
        meant = builder.icmp_signed("<", ir.Constant(mask, list(range(RUN))), repeated(arguments[4], mask))
        drawn = builder.and_(meant, builder.fcmp_ordered(">", depth, before))
        builder.store(builder.select(drawn, depth, before), place, align=4)
        for array, value in ((1, along(7)), (2, along(9))):
            place = pointer(array)
            builder.store(builder.select(drawn, value, builder.load(place, align=4)), place, align=4)
        return builder.icmp_unsigned("!=", builder.bitcast(drawn, ir.IntType(RUN)), ir.Constant(ir.IntType(RUN), 0))

    number = types.float32
    return types.boolean(nearest, first, second, types.intp, types.int32, *[number] * 6), generate
