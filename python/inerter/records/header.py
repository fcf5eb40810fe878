"""What a column's header says: its name, its unit, and which of our quantities it may be.

`Force_kN`, `Displacement, mm`, `F [N]`, `Kraft (kN)`, `Time/s`, `Weg in mm`: benches write names
and units in their own language. A name is trusted where it is ours, else where it is a usual one,
else where one of its words is and the unit agrees.
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache

from inerter.unit_text import parse_unit

from .turning import OWN_NAMES, WORDS, turns

# usual names, without accents; of a word within a name the unit has to agree
_WORDS = {
    "time": "t time zeit prufzeit pruefzeit messzeit laufzeit testzeit uhrzeit temps tiempo tempo "
    "tijd czas tid cas timestamp stamp datetime zeitstempel elapsed millis micros milliseconds "
    "microseconds millisekunden seconds sekunden secondes segundos secondi sekundy aika "
    "время 时间 時間 试验时间 経過時間",
    "displacement": "x displacement disp displ weg standardweg traversenweg verschiebung hub "
    "auslenkung position pos extension stroke travel crosshead deplacement course desplazamiento "
    "spostamento corsa deslocamento verplaatsing przemieszczenie lvdt deflection actuator "
    "langenanderung laengenaenderung forskydning перемещение 位移 変位 行程 横梁位移 ストローク",
    "force": "f force kraft standardkraft prufkraft pruefkraft last load loadcell fuerza forza "
    "forca kracht sila siła kraftaufnehmer effort kraftsensor сила усилие нагрузка 力 荷重 试验力 "
    "载荷 负荷 試験力",
    "velocity": "v velocity speed geschwindigkeit vitesse velocidad velocita snelheid predkosc "
    "скорость 速度",
    "acceleration": "a acceleration acc accel beschleunigung aceleracion accelerazione aceleracao "
    "versnelling przyspieszenie ускорение 加速度",
}
_NAMES = {word: quantity for quantity, words in _WORDS.items() for word in words.split()}
_UNITS = {
    "time": "s", "displacement": "m", "force": "N", "velocity": "m/s", "acceleration": "m/s^2",
}  # fmt: skip
_TURNING = {word: quantity for quantity, words in WORDS.items() for word in words.split()}
_NAMES |= _TURNING
_PHRASES = {
    "load cell": "force", "date time": "time", "datum zeit": "time", "datum uhrzeit": "time",
    "fecha hora": "time", "date heure": "time", "elapsed time": "time", "time stamp": "time",
    "running time": "time", "total time": "time", "x value": "time",
}  # fmt: skip
# of names that are a unit
_WITHIN = {
    "millis": "ms", "milliseconds": "ms", "millisekunden": "ms", "micros": "us",
    "microseconds": "us",
}  # fmt: skip
# a channel of a controller or a summary, not what was measured
_WANTED = {
    "soll", "sollwert", "sollweg", "sollkraft", "set", "setpoint", "target", "command", "cmd",
    "demand", "reference", "ref", "desired", "consigne", "consigna", "error", "fehler", "max",
    "maximum", "min", "minimum", "mean", "peak",
}  # fmt: skip

# as benches spell units; the case counts, as in mN and MN
_SPELLED = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sekunden": "s", "sek": "s",
    "msec": "ms", "msecs": "ms", "milliseconds": "ms", "usec": "us",
    "newton": "N", "newtons": "N", "kilonewton": "kN", "kilonewtons": "kN",
    "millimeter": "mm", "millimetre": "mm", "millimeters": "mm", "inch": "in", "inches": "in",
    "meter": "m", "metre": "m", "volt": "V", "volts": "V", "lb": "lbf", "lbs": "lbf",
    "mm/sec": "mm/s", "in/sec": "in/s", "m/sec": "m/s", "g's": "g",
    "u/min": "rpm", "1/min": "rpm", "min-1": "rpm", "rev/min": "rpm",
    "с": "s", "сек": "s", "мс": "ms", "м": "m", "см": "cm", "мм": "mm", "мкм": "um", "н": "N",
    "кн": "kN", "м/с": "m/s", "мм/с": "mm/s", "秒": "s", "毫秒": "ms", "米": "m", "毫米": "mm",
    "微米": "um", "牛": "N", "千牛": "kN",
}  # fmt: skip


def split_header(header: str) -> tuple[str, str | None]:
    """Column name and unit of a header cell: ``" Force (kN) "`` -> ``("force", "kN")``.

    The name is lower case with blanks and hyphens turned into ``_``; the unit stands in square or
    round brackets at the end and is None where there is none. Also ``Force_kN``,
    ``Displacement, mm``, ``Time/s`` and ``Weg in mm``, where the name is a usual one.
    """
    text, unit = _in_brackets(header)
    if unit is None:
        text, unit = _behind(text)
    if unit is None:
        unit = _WITHIN.get(text.casefold())
    return re.sub(r"[\s\-]+", "_", text.casefold()), unit


def bare_name(header: str) -> str:
    """The name as it is written, without its unit."""
    text, unit = _in_brackets(header)
    return text if unit is not None else _behind(text)[0]


def _in_brackets(header: str) -> tuple[str, str | None]:
    text = header.strip().strip("\ufeff\"'").strip()
    match = re.fullmatch(r"(.*?)[\s,/_]*(?:\[([^\[\]]*)\]|\(([^()]*(?:\([^()]*\)[^()]*)?)\))", text)
    if match is None or not match[1]:
        return _within_brackets(text)
    unit = (match[2] if match[2] is not None else match[3]).strip()
    if match[3] is not None and parse_unit(unit) is None and bench_unit(unit) is None:
        # round brackets may hold a remark: `Force (raw)` is no force in raws
        return (text, None) if not _looks_like_unit(unit) else (match[1], unit)
    return match[1], _spelled(unit) or None


def _within_brackets(text: str) -> tuple[str, str | None]:
    """`Time (s) Run #1`: the unit amid a name that is a usual one of its quantity."""
    match = re.fullmatch(r"([^\[\]()]+?)\s*[\[(]([^\[\]()]+)[\])]\s+([^\[\]()]+)", text)
    if match is None:
        return text, None
    quantity, unit = _best_guess(match[1]), bench_unit(match[2])
    if quantity is None or not (agrees(quantity, unit) or unit in ("V", "mV")):
        return text, None
    return f"{match[1]} {match[3]}", unit


def _looks_like_unit(text: str) -> bool:
    return len(text) <= 5 and not text.islower()


def _behind(text: str) -> tuple[str, str | None]:
    """The unit behind a comma, a stroke, an underscore or the word "in", of a usual name."""
    match = re.fullmatch(r"(.*?\w)(?:\s*,\s*|\s*/\s*|_|\s+in\s+|\s+)([^\s,_]+)", text)
    if match is None:
        return text, None
    quantity = _best_guess(match[1])
    unit = bench_unit(match[2])
    if quantity is None and re.search(r"\s/\s", text) and any(agrees(q, unit) for q in _UNITS):
        # as standards write it, whatever the quantity's sign: `s / mm`
        return match[1], unit
    if quantity is None or not (agrees(quantity, unit) or unit in ("V", "mV")):
        return text, None
    plain = _words(match[2])
    # "load cell", "time t": a word is no unit where it may be a name
    if re.search(rf"{re.escape(match[1])}\s+{re.escape(match[2])}$", text) and (
        (len(match[2]) == 1 and match[2] != _UNITS[quantity])
        or (plain and plain[0] in _NAMES and match[2] not in ("ms",))
    ):
        return text, None
    return match[1], unit


def _spelled(unit: str) -> str:
    return _SPELLED.get(unit.casefold(), unit)


@cache
def bench_unit(cell: str) -> str | None:
    """The unit that a cell states, as pint spells it; None where it is none."""
    text = cell.strip().strip("[]() ").strip()
    if not text or len(text) > 16 or re.search(r"\d{3}", text):
        return None
    text = _spelled(text)
    if text in ("V", "mV", "g", "rpm", "%", "°", "deg", "rad", "bar", "A", "V/V", "mV/V"):
        return text
    if parse_unit(text) is None:
        return None
    # pint knows many words: of longer ones those alone that a bench writes
    letters = re.sub(r"[^A-Za-zµμ]", "", text)
    if len(letters) > 4 and not re.search(r"[/*^·]", text):
        return None
    return text


def _words(name: str) -> list[str]:
    text = unicodedata.normalize("NFKD", name.casefold())
    text = "".join(c for c in text if not unicodedata.combining(c))
    return [word for word in re.split(r"[^\w']+|_|(?<=\D)(?=\d)", text) if word]


def _telling_words(name: str) -> list[str]:
    """Words without numbers; of a path such as `/strut/force` those of its last part."""
    return [w for w in _words(name.rsplit("/", 1)[-1] if name[:1] == "/" else name)
            if not w.isdigit()]  # fmt: skip


def _best_guess(name: str) -> str | None:
    words = _telling_words(name)
    phrase = " ".join(words)
    if phrase in _PHRASES:
        return _PHRASES[phrase]
    if len(words) == 1:
        return _NAMES.get(words[0])
    found = {_NAMES[word] for word in words if word in _NAMES and len(word) > 1}
    return found.pop() if len(found) == 1 else None


def agrees(quantity: str, unit: str | None) -> bool:
    """Whether a unit is one of a quantity."""
    if unit is None:
        return False
    if quantity == "acceleration" and unit in ("g", "G", "gn", "mg"):
        return True
    if quantity == "force" and unit in ("kp",):
        return True
    parsed = parse_unit(unit)
    if parsed is None:
        return False
    return turns(quantity, parsed) or (
        parsed.dimensionality == parse_unit(_UNITS[quantity]).dimensionality
    )


def quantity_of(header: str, only: str | None = None) -> int | None:
    """How well a header names one of our quantities: 3 ours, 2 a usual name, 1 a word of it.

    0 (None without `only`) where it does not. A unit of another quantity makes it none.
    """
    rank = guess(header)
    if rank is None or (only is not None and rank[0] != only):
        return 0 if only is not None else None
    return rank[1]


@cache
def guess(header: str) -> tuple[str, int] | None:
    """The quantity that a header names and how well, see `quantity_of`; None for no one.

    Of names and units of a device that turns, 0: what moves along a line comes first.
    """
    name, unit = split_header(header)
    if name in _UNITS:
        return name, 3
    if name in OWN_NAMES:
        return OWN_NAMES[name], 0
    quantity = _best_guess(bare_name(header))
    if quantity is None or (unit is not None and not agrees(quantity, unit)):
        return None
    words = _telling_words(bare_name(header))
    whole = len(words) == 1
    if any(w in _TURNING for w in words) or (unit and turns(quantity, parse_unit(unit))):
        return (quantity, 0) if whole or unit is not None else None
    if whole or " ".join(words) in _PHRASES:
        # a time of day needs no unit; a date and a time of day neither
        return quantity, 2
    return (quantity, 1) if unit is not None else None


def named_as(header: str) -> str | None:
    """The quantity that a name is a usual one of, whatever its unit; None for no one."""
    name = split_header(header)[0]
    return name if name in _UNITS else OWN_NAMES.get(name) or _best_guess(bare_name(header))


def is_wanted(header: str) -> bool:
    """Whether a name says that it is a set point, an error or a summary: nothing measured."""
    return not _WANTED.isdisjoint(_words(bare_name(header)))


def of_unit(header: str, quantity: str) -> bool:
    """Whether a column has a unit of a quantity, whatever its name."""
    return agrees(quantity, split_header(header)[1])
