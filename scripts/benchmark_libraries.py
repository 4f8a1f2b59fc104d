"""
Install what `make bench` measures beside, each library if it can be had.

The report names those that are missing. They are large, and pinned here and not in uv.lock.

"""

from importlib.util import find_spec
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile

ROOT = Path(__file__).resolve().parents[1]
LOG = ROOT / 'log' / 'benchmark_libraries.log'
# frax asks for a JAX before 0.4.32, which is several times faster on a CPU for single calls.
# Python 3.13 has none.
REQUIREMENTS = {
    'pydrake': ['drake==1.58.0'],
    'roboticstoolbox': ['roboticstoolbox-python==1.5.0'],
    'frax': ['jax==0.4.30', 'jaxlib==0.4.30', 'frax==0.1.0'],
}
# Debian's and Ubuntu's PyKDL is built for their own Python: it gets an environment of its own.
SYSTEM_PYTHON = '/usr/bin/python3'
KDL = Path(sys.prefix) / 'kdl'


def run(*command, **options):
    """Run a command; its output goes to the log."""
    with LOG.open('a') as log:
        subprocess.run(command, check=True, stdout=log, stderr=log, **options)


def uv():
    """Return the program uv: see scripts/lib/python.sh."""
    return shutil.which('uv') or str(ROOT / 'log' / 'uv' / 'bin' / 'uv')


def install(requirements):
    """Install into this environment, without another version of what is locked."""
    frozen = ROOT / 'log' / 'installed.txt'
    installed = subprocess.run(
        [uv(), 'pip', 'freeze', '--python', sys.executable],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    frozen.write_text('\n'.join(line for line in installed.splitlines() if '==' in line))
    run(uv(), 'pip', 'install', '--python', sys.executable, '-c', str(frozen), *requirements)


def kdl_works():
    """Tell whether PyKDL's environment is complete."""
    python = KDL / 'bin' / 'python'
    environment = {'LD_LIBRARY_PATH': str(KDL / 'lib'), 'PYTHONPATH': str(ROOT)}
    command = [str(python), '-c', 'import PyKDL, dynamics_node']
    return (
        python.exists()
        and subprocess.run(command, env=environment, capture_output=True, check=False).returncode
        == 0
    )


def install_kdl():
    """Unpack PyKDL into an environment of the system's Python; nothing goes into the system."""
    if find_spec('PyKDL') is not None or kdl_works():
        return
    depends = subprocess.run(
        ['apt-cache', 'depends', 'python3-pykdl'], capture_output=True, text=True, check=True
    ).stdout
    library = next(word for word in depends.split() if word.startswith('liborocos-kdl'))
    with tempfile.TemporaryDirectory() as folder:
        run('apt-get', 'download', 'python3-pykdl', library, cwd=folder)
        for package in Path(folder).glob('*.deb'):
            run('dpkg-deb', '-x', str(package), folder)
        shutil.rmtree(KDL, ignore_errors=True)
        run(uv(), 'venv', '--no-project', '--python', SYSTEM_PYTHON, str(KDL))
        python = str(KDL / 'bin' / 'python')
        run(uv(), 'pip', 'install', '--python', python, 'numpy', 'numba', 'scipy', 'yourdfpy')
        (packages,) = (KDL / 'lib').glob('python3.*/site-packages')
        for file in Path(folder, 'usr/lib/python3/dist-packages').glob('PyKDL*.so'):
            shutil.copy(file, packages)
        for file in Path(folder, 'usr/lib').glob('*/liborocos-kdl.so.*'):
            shutil.copy(file, KDL / 'lib', follow_symlinks=False)
    if not kdl_works():
        raise RuntimeError('PyKDL cannot be imported')


def main():
    """Install what is missing, and say in one line what cannot be had."""
    LOG.parent.mkdir(exist_ok=True)
    missing = []
    for module, requirements in REQUIREMENTS.items():
        try:
            if find_spec(module) is None:
                install(requirements)
        except (OSError, subprocess.CalledProcessError):
            missing.append(module)
    try:
        install_kdl()
    except (OSError, subprocess.CalledProcessError, RuntimeError, StopIteration):
        missing.append('PyKDL')
    if missing:
        print(f'not installed: {", ".join(missing)} (why: {LOG.relative_to(ROOT)})')


if __name__ == '__main__':
    main()
