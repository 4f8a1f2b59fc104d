"""URDF files: arm7 in the installed package or the checkout, and any other."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory, PackageNotFoundError

from .robot_text import RobotRefusedError

ARM7 = Path('config') / 'robots' / 'arm7.urdf'


def arm7_path() -> Path:
    """Return the path of arm7.urdf."""
    try:
        installed = Path(get_package_share_directory('dynamics_node')) / ARM7
    except PackageNotFoundError:
        installed = None
    if installed is not None and installed.is_file():
        return installed
    return Path(__file__).resolve().parents[2] / ARM7


def read_robot(path: Path) -> str:
    """Return the text of a URDF file."""
    try:
        return path.read_text(encoding='utf-8')
    except (OSError, UnicodeDecodeError) as error:
        raise RobotRefusedError(f'cannot read the robot description {path}: {error}') from error
