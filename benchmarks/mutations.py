"""Small mistakes in Python code: the changes of one token or one statement that `mutants.py` draws from."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

OTHERS: dict[type[ast.AST], list[type[Any]]] = {
    ast.Lt: [ast.LtE, ast.GtE], ast.LtE: [ast.Lt, ast.Gt], ast.Gt: [ast.GtE, ast.LtE], ast.GtE: [ast.Gt, ast.Lt],
    ast.Eq: [ast.NotEq], ast.NotEq: [ast.Eq], ast.Is: [ast.IsNot], ast.IsNot: [ast.Is], ast.In: [ast.NotIn],
    ast.NotIn: [ast.In], ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div], ast.Div: [ast.Mult],
    ast.FloorDiv: [ast.Mult], ast.Mod: [ast.FloorDiv], ast.LShift: [ast.RShift], ast.RShift: [ast.LShift],
    ast.BitAnd: [ast.BitOr], ast.BitOr: [ast.BitAnd], ast.And: [ast.Or], ast.Or: [ast.And],
}  # fmt: skip
LEFT_ALONE = (ast.JoinedStr, ast.Import, ast.ImportFrom, ast.arg)
NOT_WALKED = ("annotation", "returns", "decorator_list")
OF_THE_MACHINE = ("sys.platform", "os.name", "TYPE_CHECKING", "sys.version_info")
COMPILED = ("kernel", "intrinsic")  # names of decorators


@dataclass(frozen=True)
class Mutation:
    """One change of a file.

    Attributes:
        path: Below `src`.
        lines: Python says that it runs one of these when it runs the changed part.
        line: Of the changed part.
        start: Of the bytes that are replaced.
        end: Of the bytes that are replaced.
        text: In their place.
    """

    path: str
    lines: range
    line: int
    start: int
    end: int
    text: str

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.text.encode() + source[self.end :]

    def row(self, source: bytes, verdict: str) -> str:
        """A row of the table: file, line, what stood there, what stands there, verdict."""
        first, last = source.rfind(b"\n", 0, self.start) + 1, source.find(b"\n", self.end) - len(source)
        texts = (" ".join(text[first:last].decode().split())[:120] for text in (source, self.apply(source)))
        before, after = (f"`` {text} ``".replace("|", "\\|") for text in texts)
        return f"| {self.path} | {self.line} | {before} | {after} | {verdict} |"


def _texts(node: ast.AST, inside: bool) -> Iterator[str]:
    """What may stand in a node's place; `inside` a function statements may be missing."""
    match node:
        case ast.Expr(value=ast.Constant()):
            pass  # a docstring
        case ast.Expr() | ast.Assign() | ast.AugAssign() | ast.Raise() | ast.Delete() if inside:
            yield "pass"
        case ast.Break() | ast.Continue():
            yield "continue" if isinstance(node, ast.Break) else "break"
        case ast.Return(value=ast.expr() as value) if ast.unparse(value) != "None":
            yield "return None"
        case ast.Compare(left=left, ops=ops, comparators=right):
            for index, op in enumerate(ops):
                for other in OTHERS[type(op)]:
                    yield f"({ast.unparse(ast.Compare(left, [*ops[:index], other(), *ops[index + 1 :]], right))})"
        case ast.BinOp(op=op) | ast.BoolOp(op=op) if type(op) in OTHERS:
            yield f"({ast.unparse(type(node)(**dict(ast.iter_fields(node)) | {'op': OTHERS[type(op)][0]()}))})"
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield f"({ast.unparse(operand)})"
        case ast.Constant(value=bool(value)):
            yield str(not value)
        case ast.Constant(value=int(value)):
            yield from (str(value + 1), f"({value - 1})")
        case ast.Constant(value=float(value)):
            yield repr(value * 1.5 if value else 0.5)


def find_mutations(path: str, source: bytes) -> list[Mutation]:
    """All mutations of a file. Docstrings, annotations, decorators and words of errors and logs stay as they are."""
    starts = [0, 0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def walk(node: Any, lines: range, inside: bool, kernel: bool, test: bool) -> Iterator[Mutation]:
        if isinstance(node, ast.stmt) and not kernel:  # a kernel is seen where it is defined
            decorators = getattr(node, "decorator_list", [])
            last = node.body[0].lineno - 1 if hasattr(node, "body") else node.end_lineno
            lines = range(min(d.lineno for d in [node, *decorators]), max(node.lineno, last or 0) + 1)
            kernel = any(name in ast.unparse(d) for d in decorators for name in COMPILED)
        inside = inside or isinstance(node, ast.FunctionDef)
        match node:
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="log")))) | ast.keyword(arg="strict"):
                return
            case ast.If(test=condition) | ast.IfExp(test=condition):
                if any(name in ast.unparse(condition) for name in OF_THE_MACHINE):
                    return
        for text in list(_texts(node, inside)) or ([f"(not {ast.unparse(node)})"] if test else []):
            first, last = starts[node.lineno] + node.col_offset, starts[node.end_lineno] + node.end_col_offset
            yield Mutation(path, lines, node.lineno, first, last, text)
        if isinstance(node, ast.Raise):  # its words
            return
        for name, value in ast.iter_fields(node):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and name not in NOT_WALKED and not isinstance(child, LEFT_ALONE):
                    yield from walk(child, lines, inside, kernel, name == "test")

    return list(walk(ast.parse(source), range(1), False, False, False))
