"""A producer of the Arrow C stream interface, of nothing but ctypes: what polars, pyarrow or DuckDB hand over."""

import ctypes as c


class ArrowSchema(c.Structure):
    pass


class ArrowArray(c.Structure):
    pass


class ArrowArrayStream(c.Structure):
    pass


release_schema = c.CFUNCTYPE(None, c.POINTER(ArrowSchema))
release_array = c.CFUNCTYPE(None, c.POINTER(ArrowArray))
ArrowSchema._fields_ = [
    ("format", c.c_char_p), ("name", c.c_char_p), ("metadata", c.c_char_p), ("flags", c.c_int64), ("n_children", c.c_int64),
    ("children", c.POINTER(c.POINTER(ArrowSchema))), ("dictionary", c.POINTER(ArrowSchema)), ("release", release_schema),
    ("private_data", c.c_void_p)]
ArrowArray._fields_ = [
    ("length", c.c_int64), ("null_count", c.c_int64), ("offset", c.c_int64), ("n_buffers", c.c_int64), ("n_children", c.c_int64),
    ("buffers", c.POINTER(c.c_void_p)), ("children", c.POINTER(c.POINTER(ArrowArray))), ("dictionary", c.POINTER(ArrowArray)),
    ("release", release_array), ("private_data", c.c_void_p)]
get_schema = c.CFUNCTYPE(c.c_int, c.POINTER(ArrowArrayStream), c.POINTER(ArrowSchema))
get_next = c.CFUNCTYPE(c.c_int, c.POINTER(ArrowArrayStream), c.POINTER(ArrowArray))
last_error = c.CFUNCTYPE(c.c_char_p, c.POINTER(ArrowArrayStream))
release_stream = c.CFUNCTYPE(None, c.POINTER(ArrowArrayStream))
ArrowArrayStream._fields_ = [("get_schema", get_schema), ("get_next", get_next), ("get_last_error", last_error),
                             ("release", release_stream), ("private_data", c.c_void_p)]

new_capsule = c.pythonapi.PyCapsule_New
new_capsule.restype = c.py_object
new_capsule.argtypes = [c.c_void_p, c.c_char_p, c.c_void_p]

codes = {"c": c.c_int8, "C": c.c_uint8, "s": c.c_int16, "S": c.c_uint16, "i": c.c_int32, "I": c.c_uint32, "l": c.c_int64,
         "L": c.c_uint64, "e": c.c_uint16, "f": c.c_float, "g": c.c_double}


def bits(flags):
    packed = bytearray((len(flags) + 7) // 8)
    for i, flag in enumerate(flags):
        packed[i // 8] |= bool(flag) << (i % 8)
    return c.create_string_buffer(bytes(packed), len(packed) or 1)


class Stream:
    """columns: (name, format, values) with None for null; ``batches`` is how rows are cut, ``skip`` how many rows lie before
    them in the buffers (the offset). ``released`` counts what the consumer gave back."""

    def __init__(self, columns, batches, skip=0, dictionaries=None, fail=None):
        self.columns, self.batches, self.skip, self.fail = columns, list(batches), skip, fail
        self.dictionaries = dictionaries or {}
        self.keep, self.released, self.made = [], 0, 0

    def __arrow_c_stream__(self, requested_schema=None):
        stream = ArrowArrayStream()
        self.at = 0
        self.callbacks = (get_schema(self._schema), get_next(self._next), last_error(lambda _: self.fail),
                          release_stream(self._release_stream))
        stream.get_schema, stream.get_next, stream.get_last_error, stream.release = self.callbacks
        self.stream = stream
        self.made += 1
        return new_capsule(c.addressof(stream), b"arrow_array_stream", None)

    def _release_stream(self, stream):
        self.released += 1
        stream.contents.release = release_stream()

    def _child_schema(self, name, code):
        child = ArrowSchema(format=code.encode(), name=name.encode(), flags=2)
        child.release = self._none_schema = release_schema(lambda _: None)
        self.keep.append((child, child.release))
        if name in self.dictionaries:
            words = ArrowSchema(format=b"u", name=b"", release=child.release)
            child.dictionary = c.pointer(words)
            self.keep.append(words)
        return child

    def _schema(self, _, out):
        children = [self._child_schema(n, f) for n, f, _ in self.columns]
        pointers = (c.POINTER(ArrowSchema) * len(children))(*map(c.pointer, children))

        def release(schema):
            self.released += 1
            schema.contents.release = release_schema()

        done = release_schema(release)
        self.keep.append((pointers, done))
        self.made += 1
        c.memmove(out, c.byref(ArrowSchema(format=b"+s", name=b"", n_children=len(children), children=pointers, release=done)),
                  c.sizeof(ArrowSchema))
        return 0

    def _array(self, code, values, offset):
        nulls = sum(v is None for v in values)
        valid = bits([v is not None for v in values]) if nulls else None
        if code in ("u", "U"):
            data, ends = b"", [0]
            for v in values:
                data += (v or "").encode()
                ends.append(len(data))
            kind = c.c_int32 if code == "u" else c.c_int64
            buffers = [valid, (kind * len(ends))(*ends), c.create_string_buffer(data, len(data) or 1)]
        elif code == "b":
            buffers = [valid, bits([bool(v) for v in values])]
        elif code == "n":
            buffers = []
        else:
            buffers = [valid, (codes[code] * len(values))(*[0 if v is None else v for v in values])]
        pointers = (c.c_void_p * max(1, len(buffers)))(*[c.addressof(b) if b is not None else None for b in buffers])
        quiet = release_array(lambda _: None)
        array = ArrowArray(length=len(values) - offset, null_count=-1 if nulls else 0, offset=offset, n_buffers=len(buffers),
                           buffers=pointers, release=quiet)
        self.keep.append((buffers, pointers, quiet, array))
        return array

    def _next(self, _, out):
        if self.fail:
            return 5
        if not self.batches:
            c.memset(out, 0, c.sizeof(ArrowArray))
            return 0
        rows = self.batches.pop(0)
        children = []
        for name, code, values in self.columns:
            junk = [values[0]] * self.skip
            child = self._array(code, junk + values[self.at:self.at + rows], self.skip)
            if name in self.dictionaries:
                child.dictionary = c.pointer(self._array("u", self.dictionaries[name], 0))
            children.append(child)
        self.at += rows
        pointers = (c.POINTER(ArrowArray) * len(children))(*map(c.pointer, children))

        def release(array):
            self.released += 1
            array.contents.release = release_array()

        done = release_array(release)
        self.keep.append((pointers, done))
        self.made += 1
        c.memmove(out, c.byref(ArrowArray(length=rows, n_children=len(children), children=pointers, n_buffers=1,
                                          buffers=(c.c_void_p * 1)(None), release=done)), c.sizeof(ArrowArray))
        return 0
