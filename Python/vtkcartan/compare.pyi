from typing import Any, Sequence

METHODS: tuple[str, ...]

def compare_methods(source: Any | None = ..., methods: Sequence[str] = ...) -> list[Any]: ...
