"""Threads stay as they were found."""

from __future__ import annotations

import os
import threading

import numpy as np
import pytest

from eigenfield.coding.pictures.pictures_10bit import MIN_SIDE_TEXELS, encode_10bit
from eigenfield.coding.video.av1 import encode_video
from eigenfield.runtime.parallel import TASKS_FOLDER, ordinary_scheduling, parallel_map

pytestmark = pytest.mark.skipif(
    not hasattr(os, "sched_setscheduler") or os.geteuid() != 0, reason="only root's threads become real-time"
)


def policies() -> set[int]:
    return {os.sched_getscheduler(int(task.name)) for task in TASKS_FOLDER.iterdir()}


def make_real_time() -> None:
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))


def test_real_time_threads_become_ordinary_again():
    stop = threading.Event()
    found = []

    def work():
        with ordinary_scheduling():
            make_real_time()
            threading.Thread(target=stop.wait, daemon=True).start()
            found.append(os.SCHED_FIFO in policies())
        found.append(os.SCHED_FIFO in policies())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    stop.set()
    assert found == [True, False]


def test_a_process_that_was_started_real_time_stays_so():
    found = []

    def work():
        make_real_time()
        with ordinary_scheduling():
            pass
        found.append(os.sched_getscheduler(0))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [os.SCHED_FIFO]


def test_no_encoder_leaves_a_real_time_thread():
    codes = np.zeros((MIN_SIDE_TEXELS, MIN_SIDE_TEXELS), np.uint16)
    half = np.zeros((MIN_SIDE_TEXELS // 2, MIN_SIDE_TEXELS // 2), np.uint16)
    parallel_map(lambda crf: encode_10bit(codes, crf, 8), [20, 30, 40])
    encode_video([(codes, half, half)], codes.shape, 30, 8)
    assert os.SCHED_FIFO not in policies()
