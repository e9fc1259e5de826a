"""DuckDB by its C interface, of nothing but ctypes: what a reader of Arrow does with a stream."""

import ctypes as c
import glob
import os

from conftest import source

_places = [os.path.join(source, "setup", "node_modules", "@duckdb", "node-bindings-linux-x64", "libduckdb.so"),
           *glob.glob("/usr/lib/*/libduckdb.so*")]
library = next((place for place in _places if os.path.exists(place)), None)


class _Result(c.Structure):
    _fields_ = [("numbers", c.c_uint64 * 6)]  # six words


class Session:
    """A database in memory; ``take`` reads a stream, ``query`` gives rows of texts, None where a value is null."""

    def __init__(self):
        self.c = c.CDLL(library)
        self.c.duckdb_value_varchar.restype = c.c_void_p
        self.c.duckdb_value_varchar.argtypes = [c.POINTER(_Result), c.c_uint64, c.c_uint64]
        self.c.duckdb_value_is_null.restype = c.c_bool
        self.c.duckdb_value_is_null.argtypes = [c.POINTER(_Result), c.c_uint64, c.c_uint64]
        self.c.duckdb_row_count.restype = self.c.duckdb_column_count.restype = c.c_uint64
        self.c.duckdb_result_error.restype = c.c_char_p
        self.c.duckdb_free.argtypes = [c.c_void_p]
        self.database, self.connection = c.c_void_p(), c.c_void_p()
        assert self.c.duckdb_open(None, c.byref(self.database)) == 0
        assert self.c.duckdb_connect(self.database, c.byref(self.connection)) == 0

    def take(self, name, table):
        """Reads all of a table's stream into a table of the database: a stream is read once."""
        capsule = table.__arrow_c_stream__()
        pointer = c.pythonapi.PyCapsule_GetPointer
        pointer.restype, pointer.argtypes = c.c_void_p, [c.py_object, c.c_char_p]
        stream = c.c_void_p(pointer(capsule, b"arrow_array_stream"))
        assert self.c.duckdb_arrow_scan(self.connection, f"{name} stream".encode(), stream) == 0
        self.query(f'create table {name} as select * from "{name} stream"')

    def query(self, text):
        result = _Result()
        state = self.c.duckdb_query(self.connection, text.encode(), c.byref(result))
        assert state == 0, self.c.duckdb_result_error(c.byref(result))
        rows = []
        for i in range(self.c.duckdb_row_count(c.byref(result))):
            rows.append([])
            for j in range(self.c.duckdb_column_count(c.byref(result))):
                if self.c.duckdb_value_is_null(c.byref(result), j, i):
                    rows[-1].append(None)
                    continue
                text_at = self.c.duckdb_value_varchar(c.byref(result), j, i)
                rows[-1].append(c.string_at(text_at).decode())
                self.c.duckdb_free(text_at)
        self.c.duckdb_destroy_result(c.byref(result))
        return rows

    def close(self):
        self.c.duckdb_disconnect(c.byref(self.connection))
        self.c.duckdb_close(c.byref(self.database))
