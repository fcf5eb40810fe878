# MuJoCo's functions live in compiled modules without types: everything there is Any
from typing import Any

def __getattr__(name: str) -> Any: ...
