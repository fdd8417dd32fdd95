"""Text that compilers read differently, replaced by text that all read alike: what then still differs has another cause.
yardstick uses it. A replacement may compute something else; both sides are given the same."""
import re

CALL = re.compile(r"(?<!\w)(LIMIT|SH[LR]|L?REAL_TO_(?:TIME|U?[SD]?INT|BYTE|D?WORD))\s*\(", re.IGNORECASE)

# The whole part by IF alone: TRUNC has no type that all agree on.
WHOLE = """FUNCTION WHOLE_{kind} : {kind}
  VAR_INPUT
    X : {kind};
  END_VAR
  VAR
    N : DINT;
  END_VAR
  IF ABS(X) < 2.0E9 THEN
    N := {kind}_TO_DINT(X);
    IF X > 0.0 THEN
      IF DINT_TO_{kind}(N) > X THEN N := N - 1; END_IF;
    ELSE
      IF DINT_TO_{kind}(N) < X THEN N := N + 1; END_IF;
    END_IF;
    WHOLE_{kind} := DINT_TO_{kind}(N);
  ELSE
    WHOLE_{kind} := X;
  END_IF;
END_FUNCTION
"""


def replaced(name, arguments):
    """A call of `name` that all read alike; None where this one may stay."""
    if any(":=" in one for one in arguments):
        return None
    if name == "LIMIT" and len(arguments) == 3:  # crossed bounds
        low, value, high = arguments
        return f"MIN(MAX({value}, {low}), {high})"
    if name in ("SHL", "SHR") and len(arguments) == 2 and not arguments[1].isdigit():  # more places than the word has
        return f"{name}({arguments[0]}, MIN({arguments[1]}, 31))"
    if "_TO_" in name and len(arguments) == 1:  # halves, and a TIME of a fraction of a millisecond
        return f"{name}(WHOLE_{name.partition('_')[0]}({arguments[0]}))"
    return None


def alike(text, plain, own):
    """`text` with its calls replaced, innermost first; `plain` is the same without comments. `own`: names of its own."""
    result, at = "", 0
    while match := CALL.search(plain, at):
        depth, end, cuts = 1, match.end(), [match.end() - 1]  # at its brackets and commas
        while depth and end < len(plain):
            depth += {"(": 1, ")": -1}.get(plain[end], 0)
            end += 1
            if depth == 1 and plain[end - 1] == ",":
                cuts.append(end - 1)
        cuts.append(end - 1)
        arguments = [alike(text[a + 1:b], plain[a + 1:b], own).strip() for a, b in zip(cuts, cuts[1:])]
        name = match.group(1).upper()
        call = None if name in own else replaced(name, arguments)
        result += text[at:match.start()] + (call or f"{match.group(0)}{', '.join(arguments)})")
        at = end
    return result + text[at:]


def all_alike(chain):
    """A chain of parts (kind, names, text, plain) with its calls replaced; the parts before it that they need."""
    own = {name for part in chain for name in part[1]}
    parts = [(kind, names, alike(text, plain, own), plain) for kind, names, text, plain in chain]
    helpers = [("FUNCTION", [f"WHOLE_{kind}"], text, text) for kind in ("REAL", "LREAL")
               if any(f"WHOLE_{kind}(" in part[2] for part in parts) for text in [WHOLE.format(kind=kind)]]
    return helpers + parts
