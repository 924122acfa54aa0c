"""What goes wrong, by who can mend it."""

from __future__ import annotations


class InputError(ValueError):
    """Something in what was given is wrong; it reads "FILE:LINE: MESSAGE (HINT)".

    Attributes: ``file`` ("" where there is none), ``line`` (0: the file as a whole), ``message`` what is wrong, ``hint``
    what to do about it ("" where there is nothing to say).
    """

    def __init__(self, message: str, hint: str = "", file: str = "", line: int = 0) -> None:
        where = f"{file}:{line}" if line > 0 else file
        super().__init__((f"{where}: " if where else "") + message + (f" ({hint})" if hint else ""))
        self.message, self.hint, self.file, self.line = message, hint, file, line

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str, int]]:
        return InputError, (self.message, self.hint, self.file, self.line)


class OutputError(OSError):
    """A file could not be written; what stood there before still stands."""


class SceneWarning(UserWarning):
    """What reading a scene has ignored, mended or doubts."""
