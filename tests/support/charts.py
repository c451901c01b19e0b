"""Rigs and pictures of boards, made from known cameras."""

from __future__ import annotations

import av
import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from eigenfield.calibration.charts import board as boards
from eigenfield.calibration.charts.board import Board
from eigenfield.calibration.charts.bundle import BoardObservation
from eigenfield.calibration.charts.corners import DetectedCorners
from eigenfield.calibration.charts.lens_models import camera_matrix, project_points

CHECKER = boards.checkerboard(9, 6, 25.0, "mm")
CHARUCO = boards.charuco(5, 6, 30.0, 22.0, "DICT_4X4_50", "mm")
TOML = """\
columns = 4
rows = 5
dictionary = "DICT_4X4_1000"
aruco_scale = 0.75
square_size_override_cm = 5.4
inverted = true
"""

SIZE = (640, 480)
INTRINSICS = np.array([600.0, 600, 320, 240, 0, 0, 0, 0, 0])


def look_at(centre, target=(0.0, 0, 0), roll=0.0):
    """R, t of a camera at `centre`; roll in degrees about its axis."""
    forward = np.asarray(target, float) - centre
    forward /= np.linalg.norm(forward)
    right = np.cross([0, 1.0, 0], forward)
    right /= np.linalg.norm(right)
    R = np.stack([right, np.cross(forward, right), forward])
    R = Rotation.from_euler("z", roll, degrees=True).as_matrix() @ R
    return R, -R @ np.asarray(centre, float)


def rig(count=3, spacing=120.0, distance=700.0):
    """Poses of cameras on a line that look at the middle of the world."""
    xs = (np.arange(count) - (count - 1) / 2) * spacing
    return [look_at(np.array([x, 0.3 * x, -distance])) for x in xs]


def board_poses(board: Board, count=10, seed=0, tilt=35.0, spread=60.0):
    """R, t of the board about the middle of the world, tilted differently each time; its corners' middle at t."""
    random = np.random.default_rng(seed)
    middle = board.points.mean(axis=0)
    poses = []
    for _ in range(count):
        turn = np.radians(random.uniform(-tilt, tilt, 3))
        R = Rotation.from_rotvec(turn).as_matrix()
        poses.append((R, random.uniform(-spread, spread, 3) - R @ middle))
    return poses


def observations(board, cameras, poses, noise=0.2, seed=0, intrinsics=INTRINSICS):
    """What every camera sees of every board, with Gaussian noise in pixels."""
    random = np.random.default_rng(seed)
    found = []
    for c, (R, t) in enumerate(cameras):
        row = intrinsics if intrinsics.ndim == 1 else intrinsics[c]
        for m, (board_R, board_t) in enumerate(poses):
            at = project_points((board.points @ board_R.T + board_t) @ R.T + t, row)
            at = at + random.normal(0, noise, at.shape)
            found.append(BoardObservation(c, m, DetectedCorners(np.arange(len(at)), at)))
    return found


def print_board(board: Board, dots=32, legacy=False):
    """The board as printed, with a white margin of one square: (H, W) uint8, and where its first corner is in it."""
    if board.kind == "charuco":
        dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, board.dictionary))
        drawn = cv2.aruco.CharucoBoard((board.columns, board.rows), board.square, board.marker, dictionary)
        drawn.setLegacyPattern(legacy)
        sheet = drawn.generateImage((board.columns * dots, board.rows * dots))
    else:
        rows, columns = np.mgrid[: board.rows + 1, : board.columns + 1]
        sheet = np.kron((rows + columns) % 2 * 255, np.ones((dots, dots))).astype(np.uint8)
    return np.pad(sheet, dots, constant_values=255), 2 * dots


def photograph(board, camera, pose, *, inverted=False, mirrored=False, legacy=False, dots=32, noise=0.25, seed=0):
    """(H, W) uint8: the board as a camera of INTRINSICS sees it, and (n, 2) where its corners are."""
    (R, t), (board_R, board_t) = camera, pose
    sheet, first = print_board(board, dots, legacy)
    sheet = 255 - sheet if inverted else sheet
    to_board = np.array([[1, 0, -first], [0, 1, -first], [0, 0, dots / board.square]]) * board.square / dots
    plane = np.column_stack([(R @ board_R)[:, :2], R @ board_t + t])
    fine = 3
    H = np.diag([fine, fine, 1.0]) @ camera_matrix(INTRINSICS) @ plane @ to_board
    half = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])
    large = cv2.warpPerspective(
        sheet, np.linalg.inv(half) @ H @ half, (SIZE[0] * fine, SIZE[1] * fine), borderValue=60 if inverted else 180
    )
    picture = cv2.resize(large, SIZE, interpolation=cv2.INTER_AREA).astype(float) * 0.8 + 20
    picture += np.random.default_rng(seed).normal(0, noise, picture.shape)
    grey = np.clip(np.rint(picture), 0, 255).astype(np.uint8)
    at = project_points((board.points @ board_R.T + board_t) @ R.T + t, INTRINSICS)
    if mirrored:
        grey, at = np.ascontiguousarray(grey[:, ::-1]), np.stack([SIZE[0] - at[:, 0], at[:, 1]], axis=1)
    return grey, at


def write_charts(
    folder, board, cameras, poses, name="{camera}{number:02d}.png", names=("left", "middle", "right"), **how
):
    """A folder of chart pictures."""
    for c, camera in enumerate(cameras):
        for m, pose in enumerate(poses):
            path = folder / name.format(camera=names[c], number=m + 1)
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), photograph(board, camera, pose, seed=100 * c + m, **how)[0])


def write_videos(folder, board, cameras, poses, names=("cam_0", "cam_1"), **how):
    """A video a camera, of one pose a frame; the first camera's is a frame shorter."""
    folder.mkdir(exist_ok=True)
    for c, name in enumerate(names):
        with av.open(str(folder / f"{name}.mkv"), "w") as container:
            stream = container.add_stream("ffv1", rate=5)
            stream.width, stream.height = SIZE
            stream.pix_fmt = "gray"
            for m, pose in enumerate(poses if c else poses[:-1]):
                grey, _ = photograph(board, cameras[c], pose, seed=m, **how)
                container.mux(stream.encode(av.VideoFrame.from_ndarray(grey, format="gray")))
            container.mux(stream.encode())
