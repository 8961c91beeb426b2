"""Arguments of calls: misspelt names and invalid numbers are errors of this package."""

from __future__ import annotations

import functools
import inspect
import operator
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import Any, TypeVar

import numpy as np

from .errors import UsageError

Class = TypeVar("Class", bound=type)
Called = TypeVar("Called", bound=Callable[..., Any])


class ArgumentError(UsageError, TypeError):
    """A call with an unknown, missing or superfluous argument."""


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


def together(values: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a mapping and of keyword arguments, each name in one of them."""
    both = next((name for name in values if name in more), None)
    if both is not None:
        raise UsageError.saying(f"`{both}` is given twice, in the mapping and as a keyword argument; give it once")
    return {**values, **more}


def numbers(what: str, value: Any) -> np.ndarray:
    """An array of numbers."""
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

    @functools.wraps(function)
    def call(*values: Any, **given: Any) -> Any:
        try:
            return function(*values, **given)
        except TypeError as error:
            try:
                signature.bind(*values, **given)
            except TypeError as why:
                raise ArgumentError.saying(_sentence(function.__name__, signature, given, why)) from None
            # The engine names an argument of another type in its message, or in a note since Python 3.11.
            notes = [note for note in getattr(error, "__notes__", ()) if note.startswith("while processing")]
            if notes or str(error).startswith("argument '"):
                raise ArgumentError.saying(f"`{function.__name__}`: {' '.join([str(error), *notes])}") from error
            raise

    return call  # type: ignore[return-value]


def _sentence(name: str, signature: inspect.Signature, given: dict[str, Any], why: TypeError) -> str:
    known = [p.name for p in signature.parameters.values() if p.name != "self" and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    strange = next((argument for argument in given if argument not in known), None)
    if strange is None:
        return f"`{name}`: {why}"
    near = get_close_matches(strange, known, 1)
    help = f"did you mean `{near[0]}`?" if near else "there are " + ", ".join(f"`{one}`" for one in known)
    return f"`{name}` has no argument `{strange}`; {help}"
