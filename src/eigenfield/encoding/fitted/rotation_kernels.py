"""The kernel of `rotation`."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def rotated_cost(first, second, cosine, sine):
    """Sum of log(1 + x^2) over two components, (m,) each, turned by an angle: in proportion to their bits."""
    c, s = np.float32(cosine), np.float32(sine)
    total = 0.0
    product = 1.0
    for i in range(len(first)):
        a, b = c * first[i] + s * second[i], c * second[i] - s * first[i]
        product *= np.float64(np.float32(1) + a * a) * np.float64(np.float32(1) + b * b)
        if product > 1e200:
            total += np.log(product)
            product = 1.0
    return total + np.log(product)
