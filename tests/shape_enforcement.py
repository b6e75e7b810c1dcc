"""The shapes and dtypes in Tarsus's signatures, enforced while the tests run.

The annotations name jaxtyping's types, which Tarsus imports for type checkers only. The import hook of this module
wraps every function, dataclass and named tuple of the packages it is installed for: once a call has returned, its
array arguments and its result must fit their annotations together, a named dimension having one length in the whole
call. A call that raises is not checked, since functions refuse wrong shapes with messages of their own.

Whether arrays fit depends on their types, dtypes and shapes alone, so each combination is checked once per function.
Even to look that up takes as long as many a function of a control loop: of a function that is called often, the first
calls and a sample of the others are checked.
"""

from __future__ import annotations

import dataclasses
import functools
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import PathFinder, SourceFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from types import FunctionType
from typing import Any

import jaxtyping
import numpy as np
from beartype.door import is_bearable

__all__ = ["DTYPES", "NAMES_DTYPE", "Checks", "ShapeError", "enforce", "install", "load", "unchecked"]


# Number of calls of which each is checked, and the interval of those that are checked from then on.
_FIRST_CALLS, _INTERVAL = 200, 16

DTYPES = ("Bool", "Complex", "Float", "Int", "Integer", "Num", "Real", "Shaped")
NAMES_DTYPE = re.compile(rf"\b({'|'.join(DTYPES)})\[")


class ShapeError(AssertionError):
    """An array does not fit the annotation of its argument, result or field."""


def install(packages: tuple[str, ...]) -> None:
    """Enforce the annotations of every module of `packages` that is imported from now on."""
    names = tuple(f"{package}." for package in packages)
    loaded = sorted(name for name in sys.modules if f"{name}.".startswith(names))
    if loaded:
        raise RuntimeError(f"already imported, so that their shapes cannot be enforced: {', '.join(loaded)}")
    sys.meta_path.insert(0, _Finder(names))


def load(name: str, path: str) -> Any:
    """Import a file as the module `name`, its annotations enforced."""
    spec = spec_from_file_location(name, path, loader=_Loader(name, path))
    assert spec is not None
    assert spec.loader is not None
    sys.modules[name] = module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@contextmanager
def unchecked() -> Iterator[None]:
    """Let wrong shapes pass, for tests that hand them on to what refuses them."""
    Checks.active = False
    try:
        yield
    finally:
        Checks.active = True


class _Finder(MetaPathFinder):
    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> Any:
        if not f"{fullname}.".startswith(self.names):
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader:
            spec.loader = _Loader(spec.loader.name, spec.loader.path)
        return spec


class _Loader(SourceFileLoader):
    def exec_module(self, module: Any) -> None:
        super().exec_module(module)
        enforce(module)


def enforce(module: Any) -> None:
    """Wrap the functions and classes that `module` defines."""
    for name, value in list(vars(module).items()):
        if getattr(value, "__module__", None) == module.__name__ and getattr(value, "__name__", None) == name:
            if isinstance(value, FunctionType):
                setattr(module, name, _function(value))
            elif isinstance(value, type):
                _enforce_class(value)


def _enforce_class(owner: type) -> None:
    fields = _array_annotations(owner)
    record = dataclasses.is_dataclass(owner) or hasattr(owner, "_fields")
    for name, value in list(vars(owner).items()):
        if record and name in ("__init__", "__new__"):
            continue  # the fields are checked, as they are once set
        if isinstance(value, FunctionType):
            setattr(owner, name, _function(value))
        elif isinstance(value, staticmethod | classmethod):
            setattr(owner, name, type(value)(_function(value.__func__)))
        elif isinstance(value, property):
            setattr(owner, name, property(value.fget and _function(value.fget), value.fset, value.fdel, value.__doc__))
        elif isinstance(value, functools.cached_property):
            value.func = _function(value.func)
    if fields and dataclasses.is_dataclass(owner):
        owner.__init__ = _constructor(owner.__init__, owner, fields)  # type: ignore[misc]
    elif fields and hasattr(owner, "_fields"):
        owner.__new__ = _constructor(owner.__new__, owner, fields)  # type: ignore[assignment]


def _array_annotations(annotated: Any) -> dict[str, str]:
    """Return the annotations with shapes of a function, or of the fields that a class itself declares."""
    annotations = (
        vars(annotated).get("__annotations__", {}) if isinstance(annotated, type) else annotated.__annotations__
    )
    # A named tuple keeps its annotations as forward references.
    texts = {name: getattr(annotation, "__forward_arg__", annotation) for name, annotation in annotations.items()}
    return {name: text for name, text in texts.items() if isinstance(text, str) and NAMES_DTYPE.search(text)}


def _function(function: Any) -> Any:
    """Return `function`, checked after each call that returns."""
    if not isinstance(function, FunctionType):
        return function
    annotations = _array_annotations(function)
    code = function.__code__
    if code.co_flags & 0x20:  # a generator's annotation says what it yields
        annotations.pop("return", None)
    if not annotations:
        return function
    names = code.co_varnames[: code.co_argcount]
    places = [(i, name) for i, name in enumerate(names) if name in annotations]
    rest = code.co_varnames[code.co_argcount + code.co_kwonlyargcount] if code.co_flags & 0x04 else ""
    checks = Checks(function.__qualname__, function.__module__, annotations)
    returns = "return" in annotations
    calls = 0

    @functools.wraps(function)
    def checked(*args: Any, **kwargs: Any) -> Any:
        nonlocal calls
        result = function(*args, **kwargs)
        calls += 1
        if calls > _FIRST_CALLS and calls % Checks.interval:
            return result
        count = len(args)
        values = [(name, args[i]) for i, name in places if i < count]
        if rest and rest in annotations:
            values += [(rest, value) for value in args[len(names) :]]
        if kwargs:
            values += [(name, value) for name, value in kwargs.items() if name in annotations]
        if returns:
            values.append(("return", result))
        checks(values)
        return result

    return checked


def _constructor(construct: Callable[..., Any], owner: type, annotations: dict[str, str]) -> Callable[..., Any]:
    """Return a dataclass's `__init__` or a named tuple's `__new__`, after which the fields are checked."""
    checks = Checks(owner.__qualname__, owner.__module__, annotations, call=False)
    calls = 0

    @functools.wraps(construct)
    def checked(self: Any, *args: Any, **kwargs: Any) -> Any:
        nonlocal calls
        made = construct(self, *args, **kwargs)
        calls += 1
        if calls > _FIRST_CALLS and calls % Checks.interval:
            return made
        instance = self if made is None else made
        checks([(name, getattr(instance, name)) for name in annotations])
        return made

    return checked


class Checks:
    """The annotations of one function or class, and the combinations of arrays that are known to fit them."""

    active = True
    interval = _INTERVAL

    def __init__(self, name: str, module: str, annotations: dict[str, str], *, call: bool = True) -> None:
        self.name, self.module, self.annotations, self.call = name, module, annotations, call
        self.hints: dict[str, Any] = {}
        self.fitting: set[Any] = set()

    def __call__(self, values: list[tuple[str, Any]]) -> None:
        if not Checks.active:
            return
        # The common case is written out: a function call for every array would double the time that checking takes.
        key = tuple(
            [
                (name, value.dtype.char, value.shape) if type(value) is np.ndarray else (name, _signature(value))
                for name, value in values
            ]
        )
        if key in self.fitting:
            return
        self.hints = self.hints or {name: self.hint(text) for name, text in self.annotations.items()}
        with jaxtyping.jaxtyped("context"):
            for name, value in values:
                if not self._fits(value, self.hints[name], given=self.call and name != "return"):
                    raise ShapeError(
                        f"{self.module}.{self.name}: {name} is {_text(value)}; annotated {self.annotations[name]}"
                        + "".join(f"; {other} is {_text(v)}" for other, v in values if other != name)
                    )
        self.fitting.add(key)

    def hint(self, text: str) -> Any:
        """Evaluate an annotation; a name that is imported for type checkers only stands for any object."""
        names = {name: getattr(jaxtyping, name) for name in DTYPES}
        while True:
            try:
                return eval(text, vars(sys.modules[self.module]), names)
            except NameError as error:
                names[error.name] = Any

    @staticmethod
    def _fits(value: Any, hint: Any, *, given: bool) -> bool:
        if is_bearable(value, hint):
            return True
        # Functions take numbers, nested sequences and integers for an array of floats; they return arrays or numbers.
        if given or isinstance(value, int | float | complex):
            return any(is_bearable(array, hint) for array in _converted(value))
        return False


def _converted(value: Any) -> Iterator[np.ndarray]:
    """Yield the arrays that NumPy makes of `value`, as they are and as floats."""
    if isinstance(value, int | float | complex | list | tuple) or hasattr(value, "dtype"):
        try:
            array = np.asarray(value)
        except (TypeError, ValueError):
            parts = value if isinstance(value, list | tuple) and value else [None]
            if not hasattr(parts[0], "shape"):
                return
            # Values that are traced have a shape and no numbers.
            array = np.empty((len(parts), *parts[0].shape), dtype=str(parts[0].dtype))
        yield array
        if array.dtype.kind in "iu":
            yield array.astype(float)


def _signature(value: Any) -> Any:
    """Return what decides whether `value` fits an annotation."""
    kind = type(value)
    if kind is np.ndarray:
        return value.dtype, value.shape
    if kind in (tuple, list):
        return kind, tuple([_signature(part) for part in value])
    if isinstance(value, dict):
        return kind, tuple([_signature(part) for part in value.values()])
    shape = getattr(value, "shape", None)
    # NumPy itself, as the namespace in which arrays are computed, has a `shape` too: a function.
    return (kind, value.dtype, shape) if isinstance(shape, tuple) and hasattr(value, "dtype") else kind


def _text(value: Any) -> str:
    if isinstance(getattr(value, "shape", None), tuple) and hasattr(value, "dtype"):
        return f"{type(value).__name__} of {value.dtype}, shape {tuple(value.shape)}"
    return f"{type(value).__name__} {value!r:.60}"
