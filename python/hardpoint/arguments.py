"""Arguments of calls: misspelt names and invalid numbers are errors of this package."""

from __future__ import annotations

import functools
import inspect
import operator
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, TypeVar

import numpy as np

from .errors import UsageError

Class = TypeVar("Class", bound=type)
Called = TypeVar("Called", bound=Callable[..., Any])


class ArgumentError(UsageError, TypeError):
    """A call with an unknown, missing or superfluous argument."""


def amount(n: int, noun: str, plural: str = "") -> str:
    """A number with its noun: `1 cell`, `2 cells`."""
    return f"{n} {noun if n == 1 else plural or noun + 's'}"


def count(name: str, value: Any, least: int = 1) -> int | None:
    """A whole number from `least`, or None."""
    if value is None:
        return None
    try:
        whole = operator.index(value)
    except TypeError:
        whole = None
    if whole is None or isinstance(value, bool) or not least <= whole < 2**63:
        raise UsageError.saying(f"`{name}` is a whole number from {least}, not {value!r}")
    return whole


def instance(name: str, value: Any, of: type, called: str) -> None:
    """Checks that an argument is an object of a class."""
    if not isinstance(value, of):
        raise UsageError.saying(f"`{name}` is a `{called}`, not {value!r}")


def word(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise UsageError.saying(f"`{name}` is a text, not {value!r}")
    return value


def listed(name: str, value: Any) -> list[str]:
    """Names of a list, each of them once; a text is a single name."""
    if isinstance(value, str):
        return [value]
    if not hasattr(value, "__iter__"):
        raise UsageError.saying(f"`{name}` is a name or a list of names, not {value!r}")
    found: list[str] = []
    for one in value:
        if not isinstance(one, str):
            raise UsageError.saying(f"`{name}` is a name or a list of names; {one!r} is not a name")
        if one in found:
            raise UsageError.saying(f"`{name}` has `{one}` twice; name it once")
        found.append(one)
    return found


def by_name(name: str, value: Any) -> dict[str, Any]:
    """Values by names; none of None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise UsageError.saying(f"`{name}` has values by name, as in `{{'name': 1.5}}`, not {value!r}")
    return dict(value)


def same_shape(what: str, values: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Arrays by name, broadcast to one shape."""
    try:
        return dict(zip(values, np.broadcast_arrays(*values.values())))
    except ValueError:
        shapes = ", ".join(f"`{name}` {value.shape}" for name, value in values.items() if value.shape)
        raise UsageError.saying(f"the values of the {what} have different shapes: {shapes}") from None


def together(values: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a mapping and of keyword arguments, each name in one of them."""
    both = next((name for name in values if name in more), None)
    if both is not None:
        raise UsageError.saying(f"`{both}` is given twice, in the mapping and as a keyword argument; give it once")
    return {**values, **more}


def labels(value: Any) -> list | None:
    """Names along the last axis of a labelled array: the columns of a table, the index of a series, the coordinate of an array of
    xarray. `None` of unlabelled arrays, and of those that are numbered from 0."""
    if isinstance(value, Mapping):
        return None
    if hasattr(value, "dims") and hasattr(value, "indexes"):
        found = value.indexes.get(value.dims[-1]) if value.dims else None
    else:
        # A table of Arrow has names of columns besides the columns.
        kinds = (getattr(value, kind, None) for kind in ("column_names", "columns", "index"))
        found = next((kind for kind in kinds if kind is not None), None)
    if found is None or callable(found) or not hasattr(found, "__iter__"):
        return None
    names = list(found)
    return None if names == list(range(len(names))) else names


def ordered(what: str, value: Any, names: Sequence[str], kind: str = "design variable") -> np.ndarray:
    """An array of numbers, whose last axis has these names. A labelled array may have them in any order, with others."""
    own = labels(value)
    if own is None:
        return numbers(what, value)
    own = listed(f"names of {what}", own)
    missing = next((name for name in names if name not in own), None)
    if missing is not None:
        raise UsageError.saying(f"{what}: the {kind} `{missing}` is missing; there are " + ", ".join(f"`{name}`" for name in own))
    if hasattr(value, "columns") or hasattr(value, "column_names"):
        # Other columns may be texts.
        return np.column_stack([numbers(f"{what}, column `{name}`", value[name]) for name in names])
    return numbers(what, value)[..., [own.index(name) for name in names]]


def numbers(what: str, value: Any) -> np.ndarray:
    """An array of numbers."""
    if np.ma.is_masked(value) or (isinstance(value, (list, tuple)) and any(np.ma.is_masked(one) for one in value)):
        raise UsageError.saying(f"{what}: some values are masked; give all of them, or NaN where NaN has a meaning")
    try:
        found = np.asarray(value)
        # Texts of digits are no numbers either.
        if found.dtype.kind not in "biufO":
            raise TypeError
        return found.astype(float, copy=False)
    except (TypeError, ValueError):
        raise UsageError.saying(f"{what}: {value!r} is not a number or an array of numbers") from None


def number(what: str, value: Any) -> float:
    """A single number."""
    found = numbers(what, value)
    if found.ndim:
        raise UsageError.saying(f"{what}: {value!r} is not a single number")
    return float(found)


def checked(of: Class) -> Class:
    """Class whose public methods report misspelt arguments as errors of this package."""
    for name, member in list(vars(of).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(member, classmethod):
            setattr(of, name, classmethod(named(member.__func__)))
        elif inspect.isfunction(member):
            setattr(of, name, named(member))
    return of


def named(function: Called) -> Called:
    """Function that reports misspelt arguments as errors of this package."""
    signature = inspect.signature(function)
    # Of a class, what is called.
    name = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]

    @functools.wraps(function)
    def call(*values: Any, **given: Any) -> Any:
        try:
            return function(*values, **given)
        except TypeError as error:
            try:
                signature.bind(*values, **given)
            except TypeError as why:
                raise ArgumentError.saying(_sentence(name, signature, given, why)) from None
            # The engine names an argument of another type in its message, or in a note since Python 3.11.
            notes = [note for note in getattr(error, "__notes__", ()) if note.startswith("while processing")]
            if notes or str(error).startswith("argument '"):
                raise ArgumentError.saying(f"`{name}`: {' '.join([str(error), *notes])}") from error
            raise

    return call  # type: ignore[return-value]


def _sentence(name: str, signature: inspect.Signature, given: dict[str, Any], why: TypeError) -> str:
    known = [p.name for p in signature.parameters.values() if p.name != "self" and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    # A function that takes arguments of any name lacks another one.
    takes_any = any(p.kind == p.VAR_KEYWORD for p in signature.parameters.values())
    strange = None if takes_any else next((argument for argument in given if argument not in known), None)
    if strange is None:
        return f"`{name}`: {why}"
    near = get_close_matches(strange, known, 1)
    help = f"did you mean `{near[0]}`?" if near else "there are " + ", ".join(f"`{one}`" for one in known)
    return f"`{name}` has no argument `{strange}`; {help}"
