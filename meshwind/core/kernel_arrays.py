"""Assignments of rows and tables, and sums over them, inside kernels.

Numba compiles an assignment to a slice with all that it may be asked for (broadcasting, overlap, the text of an error),
which takes as long as some fifty lines of arithmetic, at each place where one is made; arithmetic with whole arrays
and NumPy's reductions take as long.
"""

from meshwind.core.kernel import njit


@njit(forceinline=True, cache=True)
def fill(row, value):
    """Set all entries of a row (n,)."""
    for k in range(len(row)):
        row[k] = value


@njit(forceinline=True, cache=True)
def copy_row(source, target):
    """Copy a row (n,) into another."""
    for k in range(len(target)):
        target[k] = source[k]


@njit(forceinline=True, cache=True)
def copy_table(source, target):
    """Copy a table (n, m) into another."""
    for i in range(target.shape[0]):
        for k in range(target.shape[1]):
            target[i, k] = source[i, k]


@njit(forceinline=True, cache=True)
def inner(one, other):
    """Inner product of two rows (n,)."""
    total = 0.0
    for k in range(len(one)):
        total += one[k] * other[k]
    return total


@njit(forceinline=True, cache=True)
def fill_table(table, value):
    """Set all entries of a table (n, m)."""
    for i in range(table.shape[0]):
        for k in range(table.shape[1]):
            table[i, k] = value
