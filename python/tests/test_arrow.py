"""Tables out by the Arrow C data interface: read back by a consumer of ctypes, by DuckDB, by what else is there, and by wearwell."""

import ctypes as c
import gc
import os
import threading
import weakref

import numpy as np
import pandas as pd
import pytest

import duckdb_c
import wearwell as ww
from arrow_stream import ArrowArray, ArrowArrayStream, ArrowSchema


@pytest.fixture(scope="module")
def fit():
    from conftest import source

    return ww.fit(os.path.join(source, "examples", "joint", "study.toml"), seed=3)


class Read:
    """Holds schema and batch of a stream until ``release``, as a consumer does."""

    def __init__(self, capsule):
        pointer = c.pythonapi.PyCapsule_GetPointer
        pointer.restype, pointer.argtypes = c.c_void_p, [c.py_object, c.c_char_p]
        self.stream = c.cast(pointer(capsule, b"arrow_array_stream"), c.POINTER(ArrowArrayStream))
        self.schema, self.array, self.end = ArrowSchema(), ArrowArray(), ArrowArray()
        get = self.stream.contents
        assert get.get_schema(self.stream, c.byref(self.schema)) == 0
        assert get.get_next(self.stream, c.byref(self.array)) == 0
        assert get.get_next(self.stream, c.byref(self.end)) == 0 and not self.end.release
        get.release(self.stream)
        assert not self.stream.contents.release
        self.names = [self.child(self.schema, i).name.decode() for i in range(self.schema.n_children)]

    @staticmethod
    def child(of, i):
        return of.children[i].contents

    def address(self, i):
        return self.child(self.array, i).buffers[1]

    def numbers(self, i):
        code = self.child(self.schema, i).format
        kind = {b"g": c.c_double, b"l": c.c_int64}[code]
        return np.ctypeslib.as_array(c.cast(self.address(i), c.POINTER(kind)), (self.array.length,)).copy()

    def unit(self, i):
        metadata = self.child(self.schema, i).metadata
        if not metadata:
            return ""
        raw = c.string_at(c.cast(c.addressof(self.child(self.schema, i)) + ArrowSchema.metadata.offset, c.POINTER(c.c_void_p))[0], 200)
        assert raw[:4] == (1).to_bytes(4, "little") and raw[8:12] == b"unit"
        return raw[16:16 + int.from_bytes(raw[12:16], "little")].decode()

    def release(self):
        self.array.release(c.byref(self.array))
        self.schema.release(c.byref(self.schema))
        assert not self.array.release and not self.schema.release


def test_draws_go_out_without_a_copy(fit):
    table = fit.arrow("draws")
    assert table.columns == ["chain", "draw", "k", "sigma"] and len(table) == 4000
    read = Read(table.__arrow_c_stream__())
    assert read.names == table.columns
    assert read.unit(2) == "mm^3/(N m)" and read.unit(0) == ""
    for i, name in ((2, "k"), (3, "sigma")):
        values = fit.draws[name].to_numpy()
        assert read.address(i) == values.ctypes.data  # the draws themselves
        np.testing.assert_array_equal(read.numbers(i), values)
    np.testing.assert_array_equal(read.numbers(0), np.repeat(np.arange(4), 1000))
    read.release()


def test_memory_lives_until_the_last_release():
    frame = pd.DataFrame({"x": np.arange(5.0), "t": ["a", None, "ü", "", "e"], "b": [True, False, True, True, False]})
    values = frame["x"].to_numpy()
    gone = weakref.ref(values.base if values.base is not None else values)
    table = ww.arrow(frame)
    capsule = table.__arrow_c_stream__()
    read = Read(capsule)
    del table, capsule, frame, values
    gc.collect()
    np.testing.assert_array_equal(read.numbers(0), np.arange(5.0))
    # A child that was moved away outlives its parent.
    moved = ArrowArray()
    c.memmove(c.byref(moved), c.byref(read.child(read.array, 0)), c.sizeof(ArrowArray))
    read.child(read.array, 0).release = type(moved.release)()
    read.release()
    assert gone() is not None
    np.testing.assert_array_equal(np.ctypeslib.as_array(c.cast(moved.buffers[1], c.POINTER(c.c_double)), (5,)), np.arange(5.0))
    done = threading.Thread(target=lambda: moved.release(c.byref(moved)))  # from whichever thread
    done.start()
    done.join()
    gc.collect()
    assert gone() is None and not moved.release


def test_a_capsule_that_nobody_takes_leaves_nothing():
    frame = pd.DataFrame({"x": np.arange(5.0)})
    table = ww.arrow(frame)
    held = weakref.ref(table)
    table.__arrow_c_stream__()
    Read(table.__arrow_c_stream__()).release()
    del table
    gc.collect()
    assert held() is None


def test_many_streams_leave_no_memory_behind():
    import resource

    frame = pd.DataFrame({"x": np.arange(100_000.0), "t": ["wear"] * 100_000})
    table = ww.arrow(frame)

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    for n in range(60):
        if n == 20:
            before = resident()
        Read(table.__arrow_c_stream__()).release()
        table.__arrow_c_stream__()
    assert resident() - before < 8e6  # a stream's texts and their ends are 0.8 MB


@pytest.mark.skipif(duckdb_c.library is None, reason="no DuckDB")
def test_duckdb_reads_tables(fit):
    session = duckdb_c.Session()
    for name in ("draws", "parameters", "lives", "sample_stats"):
        session.take(name, fit.arrow(name))
    count, mean, last = session.query("select count(*), avg(k), max(draw) from draws")[0]
    assert (int(count), int(last)) == (4000, 999)
    np.testing.assert_allclose(float(mean), fit.draws["k"].mean(), rtol=1e-12)
    assert session.query("select name, unit, exact from parameters order by name") == [
        ["k", "mm^3/(N m)", "true"], ["sigma", "mm^3", "true"]]
    assert float(session.query("select b10 from lives")[0][0]) == fit.lives.loc[0, "b10"]
    per_chain = session.query("select chain, sum(n_leapfrog), count(*) filter (divergent) from sample_stats group by chain order by chain")
    assert [int(row[1]) for row in per_chain] == fit.sample_stats.groupby("chain")["n_leapfrog"].sum().tolist()
    session.close()


@pytest.mark.skipif(duckdb_c.library is None, reason="no DuckDB")
def test_duckdb_reads_texts_with_nothing_among_them():
    session = duckdb_c.Session()
    frame = pd.DataFrame({"t": ["a", None, "größer", np.nan, ""] * 2000, "n": np.arange(10_000, dtype="int16"),
                          "f": np.arange(10_000, dtype="float32"), "b": [True, False] * 5000})
    session.take("t", ww.arrow(frame))
    assert session.query("select count(*), count(t), sum(n), sum(f), count(*) filter (b) from t") == [
        ["10000", "6000", "49995000", "49995000.0", "5000"]]
    assert session.query("select t from t where n < 5 order by n") == [["a"], [None], ["größer"], [None], [""]]
    session.close()


def test_wearwell_reads_its_own(fit):
    assert ww.table(fit.arrow("draws")).headings() == ["chain", "draw", "k", "sigma"]
    for name in ("predictions", "quantities", "lives", "parameters"):
        if len(getattr(fit, name)):
            assert ww.table(fit.arrow(name)).rows == len(getattr(fit, name))
    assert ww.table(fit.arrow("predictions-by-data-set")).rows == len(fit.tables["predictions-by-data-set"])


def test_other_readers(fit):
    polars = pytest.importorskip("polars")
    assert polars.DataFrame(fit.arrow("draws"))["k"].mean() == pytest.approx(fit.draws["k"].mean())


def test_pyarrow_reads(fit):
    pyarrow = pytest.importorskip("pyarrow")
    table = pyarrow.table(fit.arrow("draws"))
    assert table.schema.field("k").metadata == {b"unit": b"mm^3/(N m)"}


@pytest.mark.parametrize("frame, message", [
    (pd.DataFrame({"x": [1j]}), "column 'x' holds complex128"),
    (pd.DataFrame({"x": [{}]}), "row 1, column 'x': dict in a column of objects"),
    (pd.DataFrame([[1.0, 2.0]], columns=["x", "x"]), "two columns are called 'x'"),
    (pd.DataFrame({7: [1.0]}), "the heading 7 is int"),
    (3, "frame is int"),
])
def test_what_is_no_table_is_refused(frame, message):
    with pytest.raises(ValueError, match=message):
        ww.arrow(frame).__arrow_c_stream__()


def test_unknown_names_are_refused(fit):
    with pytest.raises(ValueError, match="no table 'drawz'; it has draws"):
        fit.arrow("drawz")
