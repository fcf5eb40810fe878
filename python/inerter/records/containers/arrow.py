"""Arrow files, Feather among them, by pyarrow."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from inerter.records.bounds import refuse_header
from inerter.records.record import RecordError

from .channels import Channel


def channels(path: Path, sheet: str | None) -> list[Channel]:
    """The columns of a file."""
    import pyarrow
    from pyarrow import ipc

    del sheet
    try:
        reader = ipc.open_file(pyarrow.memory_map(str(path)))
    except pyarrow.ArrowInvalid:
        raise RecordError(f"{path}: not a readable Arrow file; write it again") from None
    names = list(reader.schema.names)
    refuse_header(path, names)
    rows = sum(reader.get_batch(i).num_rows for i in range(reader.num_record_batches))
    return [
        Channel(name=name, rows=rows, group="", load=_loader(reader, index))
        for index, name in enumerate(names)
    ]


def _loader(reader: Any, index: int) -> Any:
    def load() -> Any:
        import numpy as np
        import pyarrow
        from pyarrow import types

        parts = [reader.get_batch(i).column(index) for i in range(reader.num_record_batches)]
        column = pyarrow.chunked_array(parts) if parts else pyarrow.chunked_array([[]])
        if types.is_dictionary(column.type):
            column = column.cast(column.type.value_type)
        if types.is_string(column.type) or types.is_large_string(column.type):
            return ["" if text is None else text for text in column.to_pylist()]
        if types.is_decimal(column.type):
            column = column.cast(pyarrow.float64())
        if types.is_nested(column.type) or types.is_binary(column.type):
            return np.empty(0)
        return column.to_numpy()

    return load
