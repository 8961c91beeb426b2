"""Arguments of calls: misspelt names and invalid numbers are errors of this package."""

from __future__ import annotations

import functools
import inspect
import operator
from collections.abc import Callable
from difflib import get_close_matches
from typing import Any, TypeVar

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
            raise error

    return call  # type: ignore[return-value]


def _sentence(name: str, signature: inspect.Signature, given: dict[str, Any], why: TypeError) -> str:
    known = [p.name for p in signature.parameters.values() if p.name != "self" and p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    strange = next((argument for argument in given if argument not in known), None)
    if strange is None:
        return f"`{name}`: {why}"
    near = get_close_matches(strange, known, 1)
    help = f"did you mean `{near[0]}`?" if near else "there are " + ", ".join(f"`{one}`" for one in known)
    return f"`{name}` has no argument `{strange}`; {help}"
