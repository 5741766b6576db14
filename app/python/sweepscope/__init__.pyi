from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

__version__: str

_Path = Union[str, PathLike[str]]
_Kind = Literal["stationary", "moving"]
_Stamps = Literal["header", "receive"]
_Progress = Callable[[str, float], object]
_Numbers = Sequence[float]
_Doubles = npt.NDArray[np.float64]
_Floats = npt.NDArray[np.float32]

class Error(Exception): ...
class InputError(Error): ...

class CannotAnswer(Error):
    reasons: list[str]
    estimate: Optional[Estimate]

class Estimate(Mapping[str, Any]):
    identifiable: bool
    offset_ms: Optional[float]
    sigma_ms: Optional[float]
    method: str
    warnings: list[str]
    reasons: list[str]
    criteria: dict[str, Any]
    def __getitem__(self, key: str) -> Any: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    def __getattr__(self, name: str) -> Any: ...
    def to_json(self) -> str: ...
    def save(self, path: _Path) -> None: ...

class Curve(dict[str, _Doubles]):
    offset_ms: _Doubles
    d: _Doubles
    translation_m: _Doubles
    rotation_rad: _Doubles
    signed_rotation_rad: _Doubles
    n: _Doubles
    e_m: _Doubles
    capped_cost_m: _Doubles

class Map:
    offset_ms: float
    xyz_m: _Floats
    intensity: _Floats
    time_s: _Doubles
    sweep: npt.NDArray[np.uint32]
    pose_time_s: _Doubles
    position_m: _Doubles
    orientation_xyzw: _Doubles
    moving: bool
    lost: bool
    epoch_ns: int
    def __len__(self) -> int: ...
    def __array__(self, dtype: npt.DTypeLike = None, copy: Optional[bool] = None) -> npt.NDArray[Any]: ...
    def save(self, path: _Path) -> None: ...
    def save_trajectory(self, path: _Path) -> None: ...

class Picture:
    png: bytes
    facts: Optional[dict[str, Any]]
    def _repr_png_(self) -> bytes: ...
    def save(self, path: _Path) -> None: ...

class Recording:
    @property
    def path(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def epoch_ns(self) -> int: ...
    @property
    def scans(self) -> int: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def motor_time_s(self) -> _Doubles: ...
    @property
    def motor_angle_rad(self) -> _Doubles: ...
    @property
    def scan_time_s(self) -> _Doubles: ...
    @property
    def ranges_m(self) -> _Floats: ...
    def info(self, *, progress: Optional[_Progress] = None) -> dict[str, Any]: ...
    def estimate(
        self,
        *,
        assume: Optional[_Kind] = None,
        poses: Optional[_Path] = None,
        trust_poses: bool = False,
        threads: int = 0,
        progress: Optional[_Progress] = None,
        method: Optional[Literal["stationary", "moving", "direct"]] = None,
        fit: Optional[Literal["none", "parabola"]] = None,
        scoring: Optional[Literal["two-stage", "loam"]] = None,
        weight_c: Optional[float] = None,
        edge_gate_m: Optional[float] = None,
        plane_gate_m: Optional[float] = None,
        search: Union[str, _Numbers, None] = None,
        range: Union[str, _Numbers, Sequence[Union[str, _Numbers]], None] = None,
        around: Union[str, _Numbers, None] = None,
        solve: Union[str, Sequence[str], None] = None,
        prior: Union[str, Mapping[str, float], None] = None,
        over_time: Union[str, float, bool, None] = None,
    ) -> Estimate: ...
    def curve(self, **options: Any) -> Curve: ...
    def map(
        self,
        offset_ms: float,
        *,
        assume: Optional[_Kind] = None,
        poses: Optional[_Path] = None,
        voxel_m: Optional[float] = None,
        remove_outliers: bool = False,
        threads: int = 0,
        progress: Optional[_Progress] = None,
    ) -> Map: ...
    def compare(
        self,
        offsets_ms: Optional[Sequence[float]] = None,
        *,
        curve: Union[bool, Estimate, _Path] = True,
        assume: Optional[_Kind] = None,
        poses: Optional[_Path] = None,
        output: Optional[_Path] = None,
        threads: int = 0,
        progress: Optional[_Progress] = None,
        size: Union[str, tuple[int, int], None] = None,
        title: Optional[str] = None,
        background: Optional[str] = None,
        colour_by: Optional[str] = None,
        colour_table: Optional[str] = None,
        colour_range: Union[str, _Numbers, None] = None,
        point_size: Optional[float] = None,
        viewpoint: Optional[str] = None,
        perspective: Optional[bool] = None,
        camera: Union[str, _Numbers, None] = None,
        box: Union[str, _Numbers, None] = None,
        slab: Union[str, _Numbers, Sequence[Union[str, _Numbers]], None] = None,
        close_up: Union[str, _Numbers, None] = None,
        lighting: Optional[Literal["auto", "on", "off"]] = None,
        splats: Optional[Literal["auto", "on", "off"]] = None,
        grid: Optional[Literal["auto", "on", "off"]] = None,
        scanner: Optional[Literal["auto", "on", "off"]] = None,
    ) -> Picture: ...
    def apply(
        self,
        output: Optional[_Path] = None,
        *,
        estimate: Union[Estimate, _Path, None] = None,
        offset_ms: Optional[float] = None,
        shift: Literal["motor", "laser"] = "motor",
        rig: Optional[_Path] = None,
        stamps: Optional[_Stamps] = None,
        clouds: Optional[str] = None,
        tf: bool = False,
        clouds_only: Optional[_Path] = None,
        clouds_format: Literal["pcd", "ply"] = "pcd",
        poses: Optional[_Path] = None,
        assume: Optional[_Kind] = None,
        base_frame: str = "base_link",
        again: bool = False,
        far: bool = False,
        threads: int = 0,
        progress: Optional[_Progress] = None,
    ) -> dict[str, Any]: ...

def open(
    path: _Path,
    *,
    rig: Optional[_Path] = None,
    stamps: Optional[_Stamps] = None,
    window_s: Optional[tuple[float, float]] = None,
    laser: Optional[str] = None,
    motor: Optional[str] = None,
    joint: Optional[str] = None,
    progress: Optional[_Progress] = None,
) -> Recording: ...
def info(recording: Union[Recording, _Path], *, progress: Optional[_Progress] = None) -> dict[str, Any]: ...
def estimate(
    recording: Union[Recording, _Path],
    *,
    assume: Optional[_Kind] = None,
    poses: Optional[_Path] = None,
    trust_poses: bool = False,
    threads: int = 0,
    progress: Optional[_Progress] = None,
    method: Optional[Literal["stationary", "moving", "direct"]] = None,
    fit: Optional[Literal["none", "parabola"]] = None,
    scoring: Optional[Literal["two-stage", "loam"]] = None,
    weight_c: Optional[float] = None,
    edge_gate_m: Optional[float] = None,
    plane_gate_m: Optional[float] = None,
    search: Union[str, _Numbers, None] = None,
    range: Union[str, _Numbers, Sequence[Union[str, _Numbers]], None] = None,
    around: Union[str, _Numbers, None] = None,
    solve: Union[str, Sequence[str], None] = None,
    prior: Union[str, Mapping[str, float], None] = None,
    over_time: Union[str, float, bool, None] = None,
) -> Estimate: ...
def together(
    recordings: Sequence[Union[Recording, _Path]],
    *,
    offsets: Literal["one", "each"] = "one",
    assume: Optional[_Kind] = None,
    threads: int = 0,
    progress: Optional[_Progress] = None,
    **options: Any,
) -> Estimate: ...
def curve(recording: Union[Recording, Estimate, _Path], **options: Any) -> Curve: ...
def map(
    recording: Union[Recording, _Path],
    offset_ms: float,
    *,
    assume: Optional[_Kind] = None,
    poses: Optional[_Path] = None,
    voxel_m: Optional[float] = None,
    remove_outliers: bool = False,
    threads: int = 0,
    progress: Optional[_Progress] = None,
) -> Map: ...
def compare(
    recording: Union[Recording, _Path, Sequence[Union[Map, _Path]]],
    offsets_ms: Optional[Sequence[float]] = None,
    *,
    curve: Union[bool, Estimate, _Path] = True,
    assume: Optional[_Kind] = None,
    poses: Optional[_Path] = None,
    output: Optional[_Path] = None,
    threads: int = 0,
    progress: Optional[_Progress] = None,
    size: Union[str, tuple[int, int], None] = None,
    title: Optional[str] = None,
    background: Optional[str] = None,
    colour_by: Optional[str] = None,
    colour_table: Optional[str] = None,
    colour_range: Union[str, _Numbers, None] = None,
    point_size: Optional[float] = None,
    viewpoint: Optional[str] = None,
    perspective: Optional[bool] = None,
    camera: Union[str, _Numbers, None] = None,
    box: Union[str, _Numbers, None] = None,
    slab: Union[str, _Numbers, Sequence[Union[str, _Numbers]], None] = None,
    close_up: Union[str, _Numbers, None] = None,
    lighting: Optional[Literal["auto", "on", "off"]] = None,
    splats: Optional[Literal["auto", "on", "off"]] = None,
    grid: Optional[Literal["auto", "on", "off"]] = None,
    scanner: Optional[Literal["auto", "on", "off"]] = None,
) -> Picture: ...
def figures(
    recipe: Union[_Path, dict[str, Any]],
    output: Optional[_Path] = None,
    *,
    threads: int = 0,
    progress: Optional[_Progress] = None,
) -> dict[str, Picture]: ...
def simulate(
    scene: Optional[str],
    output: _Path,
    *,
    threads: int = 0,
    progress: Optional[_Progress] = None,
    offset_ms: Optional[float] = None,
    seed: Optional[int] = None,
    duration_s: Optional[float] = None,
    noise_mm: Optional[float] = None,
    dropout: Optional[float] = None,
    scanner: Optional[str] = None,
    laser_upside_down: Optional[bool] = None,
    sweep_s: Optional[float] = None,
    motor: Optional[Literal["triangle", "trapezoid", "sine", "one-way", "stuck"]] = None,
    axis: Optional[Literal["x", "y", "z", "-x", "-y", "-z"]] = None,
    swing_deg: Optional[float] = None,
    motor_middle_deg: Optional[float] = None,
    steps_per_turn: Optional[float] = None,
    dwell_s: Optional[float] = None,
    motor_rest_s: Optional[float] = None,
    motor_rest_at_s: Optional[float] = None,
    speeds_dps: Optional[_Numbers] = None,
    speed_ramp: Optional[bool] = None,
    encoder_step_deg: Optional[float] = None,
    encoder_hz: Optional[float] = None,
    encoder_jitter_ms: Optional[float] = None,
    imu: Optional[bool] = None,
    imu_shift_ms: Optional[float] = None,
    world: Optional[str] = None,
    walk: Optional[str] = None,
    mesh: Optional[_Path] = None,
    trajectory: Optional[_Path] = None,
    trajectory_at: Union[str, _Numbers, None] = None,
    trajectory_yaw_deg: Optional[float] = None,
    trajectory_scale: Optional[float] = None,
    trajectory_upright: Optional[bool] = None,
    trajectory_from_s: Optional[float] = None,
    trajectory_smoothing_ms: Optional[float] = None,
    beam_times: Optional[Literal["spread", "instant", "reversed"]] = None,
    stamp_at: Optional[Literal["first_beam", "last_beam"]] = None,
    no_time_increment: Optional[bool] = None,
    scan_time_factor: Optional[float] = None,
    parts: Optional[int] = None,
    motor_messages: Optional[str] = None,
    motor_repeats: Optional[int] = None,
    motor_in_degrees: Optional[bool] = None,
    mixed_pixels: Optional[float] = None,
    grazing_bias_mm: Optional[float] = None,
    stamp_jitter_ms: Optional[float] = None,
    backlash_deg: Optional[float] = None,
    clock_drift_ppm: Optional[float] = None,
    jump_ms: Optional[float] = None,
    jump_at_s: Optional[float] = None,
    nudge_mm: Optional[float] = None,
    noise_per_m_mm: Optional[float] = None,
    grazing_dropout: Optional[float] = None,
    mount_error_deg: Union[str, _Numbers, None] = None,
    mount_error_mm: Union[str, _Numbers, None] = None,
    eccentricity_deg: Optional[float] = None,
    eccentricity_phase_deg: Optional[float] = None,
    uneven_motor: Optional[float] = None,
    people: Optional[int] = None,
    glass: Optional[float] = None,
) -> dict[str, Any]: ...
def scenes() -> list[str]: ...
def apply(
    recording: Union[Recording, _Path],
    output: Optional[_Path] = None,
    *,
    estimate: Union[Estimate, _Path, None] = None,
    offset_ms: Optional[float] = None,
    shift: Literal["motor", "laser"] = "motor",
    rig: Optional[_Path] = None,
    stamps: Optional[_Stamps] = None,
    clouds: Optional[str] = None,
    tf: bool = False,
    clouds_only: Optional[_Path] = None,
    clouds_format: Literal["pcd", "ply"] = "pcd",
    poses: Optional[_Path] = None,
    assume: Optional[_Kind] = None,
    base_frame: str = "base_link",
    again: bool = False,
    far: bool = False,
    threads: int = 0,
    progress: Optional[_Progress] = None,
) -> dict[str, Any]: ...
def read_estimate(path: _Path) -> Estimate: ...
