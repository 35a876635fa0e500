"""Text that notebooks show as it is."""

import html


class Shown:
    """A text; `str` of it is the text, and a notebook shows it with fixed width."""

    text: str

    def __init__(self, text: str) -> None:
        self.text = text

    def __str__(self) -> str:
        return self.text

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"
