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
SAMPLES = 4  # of a pixel at an edge
RUN = 8  # pixels drawn at once
FAST = ("fast",)


def _repeated(builder, scalar, kind):
    """A vector of `kind` with a number in all its lanes."""
    index = ir.IntType(32)
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), scalar, ir.Constant(index, 0))
    return builder.shuffle_vector(first, first, ir.Constant(ir.VectorType(index, kind.count), [0] * kind.count))


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

        def weighted(terms, weights):
            products = [builder.fmul(term, weight, flags=FAST) for term, weight in zip(terms, weights, strict=True)]
            total = products[0]
            for product in products[1:]:
                total = builder.fadd(total, product, flags=FAST)
            return total

        def texel(row, column):
            pointer = builder.gep(data, [builder.zext(builder.add(row, column), whole)])
            return builder.load(builder.bitcast(pointer, vector.as_pointer()), align=4)

        horizontal, vertical = ([_repeated(builder, weight, vector) for weight in of] for of in (across, down))
        lines = [weighted([texel(row, column) for column in columns], horizontal) for row in rows]
        total = weighted(lines, vertical)
        lanes = [builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(LANES)]
        return context.make_tuple(builder, signature.return_type, lanes)

    return result(texture, rows, columns, down, across), generate


def _square_of_taps(context, builder, signature, arguments):
    """What both bicubic intrinsics need: four pointers to a row's four texels each, their weights across as a vector,
    weights down as vectors of one number each."""
    vector, index = ir.VectorType(ir.FloatType(), LANES), ir.IntType(32)
    data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
    place, line, across, down = arguments[1:5]

    horizontal = ir.Constant(vector, ir.Undefined)
    for i in range(LANES):
        scalar = builder.extract_value(across, i)
        horizontal = builder.insert_element(horizontal, scalar, ir.Constant(index, i))
    pointers = []
    for _ in range(LANES):
        pointers.append(builder.bitcast(builder.gep(data, [place]), vector.as_pointer()))
        place = builder.add(place, line)
    return pointers, horizontal, [_repeated(builder, builder.extract_value(down, i), vector) for i in range(LANES)]


@intrinsic
def gather_bicubic(typing_context, texture, first, line, across, down):
    """sum_v down[v] sum_u across[u] texture[first + v line + u], float32, u and v from 0 to 3.

    texture: flat float32 array. across, down: tuples of four float32. Nothing is checked. Sums in this order on every
    machine: a fit's results go into files.
    """

    def generate(context, builder, signature, arguments):
        pointers, horizontal, vertical = _square_of_taps(context, builder, signature, arguments)
        rows = [builder.fmul(builder.load(p, align=4), w) for p, w in zip(pointers, vertical, strict=True)]
        total = builder.fadd(builder.fadd(rows[0], rows[1]), builder.fadd(rows[2], rows[3]))
        total = builder.fmul(total, horizontal)
        lanes = [builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(LANES)]
        return builder.fadd(builder.fadd(lanes[0], lanes[1]), builder.fadd(lanes[2], lanes[3]))

    return types.float32(texture, first, line, across, down), generate


@intrinsic
def scatter_bicubic(typing_context, texture, first, line, across, down, value):
    """The transpose of `gather_bicubic`: texture[first + v line + u] += down[v] across[u] value."""

    def generate(context, builder, signature, arguments):
        pointers, horizontal, vertical = _square_of_taps(context, builder, signature, arguments)
        share = builder.fmul(horizontal, _repeated(builder, arguments[5], horizontal.type))
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
        vector, whole = ir.VectorType(ir.FloatType(), RUN), ir.VectorType(ir.IntType(32), RUN)

        def pointer(position):
            data = context.make_array(signature.args[position])(context, builder, arguments[position]).data
            return builder.bitcast(builder.gep(data, [arguments[3]]), vector.as_pointer())

        steps = ir.Constant(vector, [float(i) for i in range(RUN)])

        def along(position):
            product = builder.fmul(steps, _repeated(builder, arguments[position + 1], vector), flags=FAST)
            return builder.fadd(_repeated(builder, arguments[position], vector), product, flags=FAST)

        place, depth = pointer(0), along(5)
        before = builder.load(place, align=4)
        meant = builder.icmp_signed("<", ir.Constant(whole, list(range(RUN))), _repeated(builder, arguments[4], whole))
        drawn = builder.and_(meant, builder.fcmp_ordered(">", depth, before))
        builder.store(builder.select(drawn, depth, before), place, align=4)
        for array, value in ((1, along(7)), (2, along(9))):
            place = pointer(array)
            builder.store(builder.select(drawn, value, builder.load(place, align=4)), place, align=4)
        return builder.icmp_unsigned("!=", builder.bitcast(drawn, ir.IntType(RUN)), ir.Constant(ir.IntType(RUN), 0))

    number = types.float32
    return types.boolean(nearest, first, second, types.intp, types.int32, *[number] * 6), generate


@intrinsic
def draw_four(typing_context, samples, at, more, a, b, c, slack, u, v):
    """A triangle in the four samples of a pixel; whether any of them was drawn.

    samples: flat float32, from `at` on four of 1 / depth, then of two texture coordinates over depth. a, b, c: the edge
    functions in the pixel's middle; more: flat float64, by how much each is more in the four samples, a's first.
    u, v: tuples of three float64, what stands at the corners. As `imaging.raster.draw_band` decides: the first
    triangle of equals stays, sums in one order on every machine.
    """

    def generate(context, builder, signature, arguments):
        double, single = ir.VectorType(ir.DoubleType(), SAMPLES), ir.VectorType(ir.FloatType(), SAMPLES)
        whole, bits = ir.IntType(64), ir.IntType(SAMPLES)
        data, offsets = (
            context.make_array(signature.args[i])(context, builder, arguments[i]).data for i in (0, 2)
        )  # fmt: skip

        def four(pointer, place, kind):
            return builder.bitcast(builder.gep(pointer, [place]), kind.as_pointer())

        def added(terms):
            return builder.fadd(builder.fadd(terms[0], terms[1]), terms[2])

        here = []
        for i, value in enumerate(arguments[3:6]):
            more = builder.load(four(offsets, whole(SAMPLES * i), double), align=8)
            here.append(builder.fadd(_repeated(builder, value, double), more))
        depth = added(here)
        least = builder.fmul(_repeated(builder, builder.fneg(arguments[6]), double), depth)
        places = [four(data, builder.add(arguments[1], whole(SAMPLES * part)), single) for part in range(3)]
        near, before = builder.fptrunc(depth, single), builder.load(places[0], align=4)
        drawn = builder.fcmp_ordered(">", near, before)
        for value in here:
            drawn = builder.and_(drawn, builder.fcmp_ordered(">=", value, least))
        builder.store(builder.select(drawn, near, before), places[0], align=4)
        for place, corners in zip(places[1:], arguments[7:], strict=True):
            ends = [_repeated(builder, builder.extract_value(corners, i), double) for i in range(3)]
            value = added([builder.fmul(weight, end) for weight, end in zip(here, ends, strict=True)])
            kept = builder.load(place, align=4)
            builder.store(builder.select(drawn, builder.fptrunc(value, single), kept), place, align=4)
        return builder.icmp_unsigned("!=", builder.bitcast(drawn, bits), ir.Constant(bits, 0))

    real = types.float64
    return types.boolean(samples, types.intp, more, real, real, real, real, u, v), generate
