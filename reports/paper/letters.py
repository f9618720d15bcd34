"""Letters and signs beyond ASCII that pdflatex sets in the encodings T1 and TS1, as ASCII commands."""

from __future__ import annotations

from unicodedata import normalize

ACCENTS = {
    "\u0300": "`", "\u0301": "'", "\u0302": "^", "\u0303": "~", "\u0304": "=", "\u0306": "u", "\u0307": ".",
    "\u0308": '"', "\u030a": "r", "\u030b": "H", "\u030c": "v", "\u0326": "textcommabelow", "\u0327": "c",
    "\u0328": "k",
}  # fmt: skip
"""Combining marks over one letter: accent commands of the LaTeX kernel."""
DOTLESS = {"i": r"\i", "j": r"\j"}
_NAMES = (
    "ß ss ẞ SS æ ae Æ AE œ oe Œ OE ø o Ø O ł l Ł L đ dj Đ DJ ð dh Ð DH þ th Þ TH ŋ ng Ŋ NG ı i ȷ j "
    "¡ textexclamdown ¿ textquestiondown ¢ textcent £ textsterling ¤ textcurrency ¥ textyen ¦ textbrokenbar "
    "§ textsection ¨ textasciidieresis © textcopyright ª textordfeminine « guillemotleft ¬ textlnot "
    "® textregistered ¯ textasciimacron ´ textasciiacute µ textmu ¶ textparagraph ¸ c º textordmasculine "
    "» guillemotright ¼ textonequarter ½ textonehalf ¾ textthreequarters ÷ textdiv ‘ textquoteleft "
    "’ textquoteright “ textquotedblleft ” textquotedblright ‚ quotesinglbase „ quotedblbase € texteuro "
    "† textdagger ‡ textdaggerdbl • textbullet ‰ textperthousand ™ texttrademark № textnumero"
)
_PAIRED = _NAMES.split()
NAMED = dict(zip(_PAIRED[::2], _PAIRED[1::2], strict=True))
PAIRS = {"ĳ": "ij", "Ĳ": "IJ", "ŉ": "'n", "ŀ": "l·", "Ŀ": "L·", "ﬁ": "fi", "ﬂ": "fl"}
"""Characters that Unicode keeps for old encodings: the letters they stand for."""


def letter(c: str) -> str | None:
    """Return the commands that set one composed character (NFC), or None if there are none."""
    if c in NAMED:
        return rf"\{NAMED[c]}{{}}"
    parts = normalize("NFD", c)
    if len(parts) == 2 and parts[0].isascii() and parts[0].isalpha() and parts[1] in ACCENTS:
        return rf"\{ACCENTS[parts[1]]}{{{DOTLESS.get(parts[0], parts[0])}}}"
    return None
