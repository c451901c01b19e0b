"""Inner loops of the surface by visibility: lines of sight through tetrahedra, and the minimal cut between them.

Tetrahedra are rows of `tetrahedra` (T, 4); slot k of `neighbours` (T, 4) is the one across the face opposite of corner
k, -1 outside. `back[t, k]` is the slot of t in that neighbour.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

CAMERA_WEIGHT = 1000.0  # of a line of sight at its camera: a camera is in free space, whatever else is said
MAX_STEPS = 100_000  # of one line: rounding could turn it round in a circle
SURE_NOISES = 3.0  # from a vertex: farther in front of it, a line of sight is sure
FREE, SOURCE, SINK = 0, 1, 2  # the trees of the flow
ROOT, ORPHAN = 4, 5  # instead of the slot of a parent


@kernel()
def back_slots(neighbours, back):
    """Fill `back`.

    Args:
        neighbours: (T, 4).
        back: (T, 4) int8, written.
    """
    for t in range(len(neighbours)):
        for k in range(4):
            u = neighbours[t, k]
            for j in range(4):
                if u >= 0 and neighbours[u, j] == t:
                    back[t, k] = j


@kernel(inline=True)
def face_normal(points, a, b, c):
    """(x, y, z) normal of a triangle, unscaled."""
    ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@kernel()
def exit_face(points, tetrahedra, t, entry, origin, direction):
    """The slot of the face through which a line leaves a tetrahedron, -1 if none, and the line's parameter there.

    Args:
        points: (n, 3).
        tetrahedra: (T, 4).
        t: The tetrahedron.
        entry: Slot of the face through which the line came.
        origin: (3,).
        direction: (3,).
    """
    best, least = -1, np.inf
    for k in range(4):
        if k == entry:
            continue
        a, corner = tetrahedra[t, (k + 1) & 3], tetrahedra[t, k]
        nx, ny, nz = face_normal(points, a, tetrahedra[t, (k + 2) & 3], tetrahedra[t, (k + 3) & 3])
        ax, ay, az = points[a, 0], points[a, 1], points[a, 2]
        inner = nx * (points[corner, 0] - ax) + ny * (points[corner, 1] - ay) + nz * (points[corner, 2] - az)
        along = nx * direction[0] + ny * direction[1] + nz * direction[2]
        if inner > 0:
            along = -along
        if along <= 0:
            continue
        at = nx * (ax - origin[0]) + ny * (ay - origin[1]) + nz * (az - origin[2])
        at = (-at if inner > 0 else at) / along
        if at < least:
            best, least = k, at
    return best, least


@kernel()
def entered_tetrahedron(points, tetrahedra, first, incident, v, direction):
    """The tetrahedron at a vertex into which a direction points, and the vertex's slot in it.

    Args:
        points: (n, 3).
        tetrahedra: (T, 4).
        first: (n + 1,) where the tetrahedra of each vertex begin in `incident`.
        incident: (4 T,).
        v: The vertex.
        direction: (3,).
    """
    best, slot, deepest = -1, -1, -np.inf
    for number in range(first[v], first[v + 1]):
        t = incident[number]
        k = 0
        while tetrahedra[t, k] != v:
            k += 1
        depth = np.inf
        for j in range(1, 4):  # inside the three faces at the vertex
            corner = tetrahedra[t, (k + j) & 3]
            a, b = tetrahedra[t, (k + j % 3 + 1) & 3], tetrahedra[t, (k + (j + 1) % 3 + 1) & 3]
            nx, ny, nz = face_normal(points, v, a, b)
            inner = nx * (points[corner, 0] - points[v, 0]) + ny * (points[corner, 1] - points[v, 1])
            inner += nz * (points[corner, 2] - points[v, 2])
            along = nx * direction[0] + ny * direction[1] + nz * direction[2]
            along /= np.sqrt(nx * nx + ny * ny + nz * nz) + 1e-300
            depth = min(depth, along if inner > 0 else -along)
        if depth > deepest:
            best, slot, deepest = t, k, depth
    return best, slot


@kernel()
def cast_votes(
    points, tetrahedra, neighbours, back, first, incident, centres, line_vertex, line_view, line_weight, noise, behind,
    capacity, excess,
):  # fmt: skip
    """What lines of sight say: free in front of their points, full behind them, and less surely near the points.

    A face at distance d from the point costs weight (1 - exp(-d^2 / 2 noise^2)) if the surface runs there, whether in
    front of the point or behind it. What flows in any case, from the camera along the line as far as it is sure, is
    taken from the capacities at once: `cut` need not find these long paths.

    Args:
        points: (n, 3).
        tetrahedra: (T, 4).
        neighbours: (T, 4).
        back: (T, 4).
        first: (n + 1,).
        incident: (4 T,).
        centres: (V, 3) of the cameras.
        line_vertex: (L,) the point of each line of sight.
        line_view: (L,) its camera.
        line_weight: (L,).
        noise: (n,) standard deviation of each point's depth.
        behind: How far behind its point a line ends, in units of noise.
        capacity: (T, 4), added to; [t, k] is what can flow from t to its neighbour: the cost if t is free and the
            other one full.
        excess: (T,), added to; positive where it is free, negative where it is full.
    """
    origin, direction = np.empty(3), np.empty(3)
    for line in range(len(line_vertex)):
        v, weight = line_vertex[line], line_weight[line]
        for side in (1.0, -1.0):
            length = 0.0
            for i in range(3):
                origin[i] = points[v, i]
                direction[i] = side * (centres[line_view[line], i] - origin[i])
                length += direction[i] * direction[i]
            length = np.sqrt(length)
            end = 1.0 if side > 0 else behind * noise[v] / length
            t, k = entered_tetrahedron(points, tetrahedra, first, incident, v, direction)
            a = tetrahedra[t, (k + 1) & 3]
            nx, ny, nz = face_normal(points, a, tetrahedra[t, (k + 2) & 3], tetrahedra[t, (k + 3) & 3])
            along = nx * direction[0] + ny * direction[1] + nz * direction[2]
            at = nx * (points[a, 0] - origin[0]) + ny * (points[a, 1] - origin[1]) + nz * (points[a, 2] - origin[2])
            at = at / along if along != 0 else np.inf
            flow = 0.0
            for _ in range(MAX_STEPS):
                u = neighbours[t, k] if k >= 0 else -1
                if at >= end or u < 0:
                    break
                entry = back[t, k]
                away = at * length / noise[v]
                cost = weight * (1.0 - np.exp(-0.5 * away * away))
                if side > 0:
                    if flow == 0 and away >= SURE_NOISES:
                        flow = weight * (1.0 - np.exp(-0.5 * SURE_NOISES * SURE_NOISES))
                        excess[t] += flow
                    capacity[u, entry] += cost - flow
                    capacity[t, k] += flow
                else:
                    capacity[t, k] += cost
                t = u
                k, at = exit_face(points, tetrahedra, t, entry, origin, direction)
            excess[t] += CAMERA_WEIGHT * weight - flow if side > 0 else -weight


@kernel()
def cut(neighbours, back, capacity, excess, tree):
    """The flow of a minimal cut (Boykov and Kolmogorov, "An Experimental Comparison of Min-Cut/Max-Flow Algorithms",
    2004). Two trees grow from source and sink until they meet; the path is filled, and what loses its parent finds
    another one or is free again.

    Args:
        neighbours: (T, 4).
        back: (T, 4).
        capacity: (T, 4) int64, from a node to its neighbours, changed.
        excess: (T,) int64, capacity from the source less that to the sink, changed.
        tree: (T,) int8 zeros, written: SOURCE on the source's side of the cut.
    """
    count = len(neighbours)
    parent = np.full(count, -1, np.int8)
    stamp, distance = np.zeros(count, np.int64), np.zeros(count, np.int32)
    queue, queued = np.empty(count, np.int32), np.zeros(count, np.bool_)
    orphans = np.empty(count, np.int32)
    head, size, flow, time = 0, 0, 0, 0
    for t in range(count):
        if excess[t] != 0:
            tree[t], parent[t], distance[t] = SOURCE if excess[t] > 0 else SINK, ROOT, 1
            queue[size], queued[t] = t, True
            size += 1
    current = -1
    while True:
        while current < 0 or tree[current] == FREE:
            if size == 0:
                return flow
            current = queue[head]
            queued[current] = False
            head, size = (head + 1) % count, size - 1
        side = tree[current]
        meet, slot = -1, -1
        for k in range(4):
            j = neighbours[current, k]
            if j < 0:
                continue
            b = back[current, k]
            if (capacity[current, k] if side == SOURCE else capacity[j, b]) <= 0:
                continue
            if tree[j] == FREE:
                tree[j] = side
                if not queued[j]:
                    queue[(head + size) % count], queued[j] = j, True
                    size += 1
            elif tree[j] != side:
                meet, slot = (current, k) if side == SOURCE else (j, b)
                break
            elif not (stamp[j] <= stamp[current] and distance[j] > distance[current]):
                continue
            parent[j], stamp[j], distance[j] = b, stamp[current], distance[current] + 1
        time += 1
        if meet < 0:
            current = -1
            continue
        # fill the path
        other = neighbours[meet, slot]
        amount = capacity[meet, slot]
        i = meet
        while parent[i] != ROOT:
            amount = min(amount, capacity[neighbours[i, parent[i]], back[i, parent[i]]])
            i = neighbours[i, parent[i]]
        amount = min(amount, excess[i])
        i = other
        while parent[i] != ROOT:
            amount = min(amount, capacity[i, parent[i]])
            i = neighbours[i, parent[i]]
        amount = min(amount, -excess[i])
        flow += amount
        capacity[meet, slot] -= amount
        capacity[other, back[meet, slot]] += amount
        lost = 0
        for sign in (1, -1):
            i = meet if sign > 0 else other
            while True:
                k = parent[i]
                if k == ROOT:
                    excess[i] -= sign * amount
                    left = excess[i]
                else:
                    j, b = neighbours[i, k], back[i, k]
                    capacity[i, k] += sign * amount
                    capacity[j, b] -= sign * amount
                    left = capacity[j, b] if sign > 0 else capacity[i, k]
                if left == 0:
                    parent[i] = ORPHAN
                    orphans[lost] = i
                    lost += 1
                if k == ROOT:
                    break
                i = j
        # adopt what lost its parent
        while lost > 0:
            lost -= 1
            i = orphans[lost]
            side = tree[i]
            best, nearest = -1, count + 1
            for k in range(4):
                j = neighbours[i, k]
                if j < 0 or tree[j] != side:
                    continue
                if (capacity[j, back[i, k]] if side == SOURCE else capacity[i, k]) <= 0:
                    continue
                steps, a, rooted = 0, j, True
                while stamp[a] != time:
                    if parent[a] == ROOT:
                        stamp[a], distance[a] = time, 1
                        break
                    if parent[a] == ORPHAN:
                        rooted = False
                        break
                    a = neighbours[a, parent[a]]
                    steps += 1
                if not rooted:
                    continue
                steps += distance[a]
                if steps < nearest:
                    best, nearest = k, steps
                a = j
                while stamp[a] != time:
                    stamp[a], distance[a] = time, steps
                    steps -= 1
                    a = neighbours[a, parent[a]]
            parent[i] = best
            if best >= 0:
                stamp[i], distance[i] = time, nearest + 1
                continue
            tree[i] = FREE
            for k in range(4):
                j = neighbours[i, k]
                if j < 0 or tree[j] != side:
                    continue
                if (capacity[j, back[i, k]] if side == SOURCE else capacity[i, k]) > 0 and not queued[j]:
                    queue[(head + size) % count], queued[j] = j, True
                    size += 1
                if 0 <= parent[j] < ROOT and neighbours[j, parent[j]] == i:
                    parent[j] = ORPHAN
                    orphans[lost] = j
                    lost += 1
