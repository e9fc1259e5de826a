"""The study of an updated fit."""

from . import _core, toml
from .study import Study, _without_table


class StudyOfAllRows(Study):
    """A study with the rows of an earlier one and new ones, kept as the state that its fit saves."""

    @classmethod
    def _of_state(cls, state, shown):
        self = cls.__new__(cls)
        self._state, self._shown = state, shown
        return self._set_state()

    def _set_state(self):
        self._read = _core.study_of_state(self._state)
        self.toml = self._read.text
        return self

    def _asking(self, predict):
        return _core.study_with_text(self._read, _without_table(self.toml, "predict") + "\n" + toml.table("predict", predict))

    def __getstate__(self):
        return {"_state": self._state, "_shown": self._shown}

    def __setstate__(self, state):
        self.__dict__.update(state)
        self._set_state()
