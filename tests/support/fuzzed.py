"""Tests of many generated inputs: a few of them in the fast suite, two hundred of each kind as slow tests, and each
night as many as EIGENFIELD_FUZZ says."""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

FEW, MANY = 12, int(os.environ.get("EIGENFIELD_FUZZ", "200"))
QUIET = {"suppress_health_check": list(HealthCheck)}


def fuzzed(check):
    """`check(folder, data)` on a few files, and on many as a slow test."""

    def run(tmp_path_factory, count):
        folder = tmp_path_factory.mktemp("fuzz")
        settings(max_examples=count, derandomize=True, **QUIET)(given(st.data())(lambda data: check(folder, data)))()

    def few(tmp_path_factory):
        run(tmp_path_factory, FEW)

    @pytest.mark.slow
    def many(tmp_path_factory):
        run(tmp_path_factory, MANY)

    return few, many
