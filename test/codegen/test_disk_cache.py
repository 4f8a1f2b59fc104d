"""Machine code on disk: trusted only if complete, in place and private."""

from dataclasses import replace
import os
import stat

from dynamics_node import RobotModel
from dynamics_node.codegen import disk_cache
from dynamics_node.kernels import recursive
from dynamics_node.kernels.packing import pack
import pytest
from support.robots import ARM7, PENDULUM

CODE = bytes(range(256)) * 40


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path / 'cache'))
    return tmp_path / 'cache'


def test_saved_code_is_loaded(folder):
    assert disk_cache.load('name') is None
    assert disk_cache.save('name', CODE)
    assert disk_cache.load('name') == CODE
    assert [path.name for path in folder.iterdir()] == ['name']


def test_the_folder_is_for_its_owner_alone(folder):
    disk_cache.save('name', CODE)
    assert folder.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize(
    'damage',
    [
        lambda content: content[:-1],
        lambda content: b'',
        lambda content: content + b'x',
        lambda content: content[:500] + bytes([content[500] ^ 1]) + content[501:],
    ],
)
def test_a_damaged_file_counts_as_missing(folder, damage):
    disk_cache.save('name', CODE)
    path = folder / 'name'
    path.write_bytes(damage(path.read_bytes()))
    assert disk_cache.load('name') is None


def test_a_file_writable_by_other_users_counts_as_missing(folder):
    disk_cache.save('name', CODE)
    (folder / 'name').chmod(0o666)
    assert disk_cache.load('name') is None


def test_a_file_under_another_name_counts_as_missing(folder):
    disk_cache.save('name', CODE)
    (folder / 'name').rename(folder / 'other')
    assert disk_cache.load('other') is None


def test_links_pipes_and_folders_count_as_missing(folder):
    disk_cache.save('name', CODE)
    (folder / 'link').symlink_to(folder / 'name')
    os.mkfifo(folder / 'pipe')
    (folder / 'folder').mkdir()
    assert [disk_cache.load(name) for name in ('link', 'pipe', 'folder')] == [None] * 3
    assert not disk_cache.save('folder', CODE)
    assert not [path for path in folder.iterdir() if path.name.startswith('new-')]


def test_a_folder_writable_by_other_users_counts_as_empty(folder):
    disk_cache.save('name', CODE)
    folder.chmod(0o777)
    assert disk_cache.load('name') is None


def test_a_folder_writable_by_other_users_is_not_changed(folder, monkeypatch):
    monkeypatch.setattr(disk_cache, '_MAX_FILES', 1)
    folder.mkdir()
    folder.chmod(0o777)
    for number in range(3):
        (folder / f'{number:064x}').write_text('theirs')
    assert not disk_cache.save('name', CODE)
    assert len(list(folder.iterdir())) == 3


def test_a_link_set_by_the_user_is_followed(folder, tmp_path):
    (tmp_path / 'disk').mkdir(mode=0o700)
    folder.symlink_to(tmp_path / 'disk')
    assert disk_cache.save('name', CODE)
    assert disk_cache.load('name') == CODE


def test_a_link_set_by_another_user_is_not_followed(folder, tmp_path, monkeypatch):
    (tmp_path / 'disk').mkdir(mode=0o700)
    folder.symlink_to(tmp_path / 'disk')
    disk_cache.save('name', CODE)
    status = list(folder.lstat())
    status[stat.ST_UID] = os.getuid() + 1
    monkeypatch.setattr(disk_cache.Path, 'lstat', lambda path: os.stat_result(status))
    assert disk_cache.load('name') is None
    assert not disk_cache.save('other', CODE)
    assert [path.name for path in (tmp_path / 'disk').iterdir()] == ['name']


def test_the_oldest_files_go(folder, monkeypatch):
    monkeypatch.setattr(disk_cache, '_MAX_FILES', 3)
    names = [f'{number:064x}' for number in range(5)]
    for number, name in enumerate(names):
        disk_cache.save(name, CODE)
        os.utime(folder / name, (number, number))
    assert sorted(path.name for path in folder.iterdir()) == names[2:]


def test_files_with_other_names_are_kept(folder, monkeypatch):
    monkeypatch.setattr(disk_cache, '_MAX_FILES', 1)
    folder.mkdir(mode=0o700)
    for name in ('thesis.tex', 'photo.jpg', 'name'):
        (folder / name).write_text('mine')
    disk_cache.save(f'{1:064x}', CODE)
    disk_cache.save(f'{2:064x}', CODE)
    assert sorted(path.name for path in folder.iterdir()) == [
        f'{2:064x}',
        'name',
        'photo.jpg',
        'thesis.tex',
    ]


def test_without_a_home_there_is_no_place(monkeypatch):
    monkeypatch.delenv('DYNAMICS_NODE_CACHE_DIR')
    monkeypatch.delenv('XDG_CACHE_HOME', raising=False)

    def no_home():
        raise RuntimeError('Could not determine home directory.')

    monkeypatch.setattr(disk_cache.Path, 'home', no_home)
    assert disk_cache.load('name') is None
    assert not disk_cache.save('name', CODE)


def test_an_unwritable_folder_is_not_an_error(tmp_path, monkeypatch):
    (tmp_path / 'file').write_text('')
    monkeypatch.setenv('DYNAMICS_NODE_CACHE_DIR', str(tmp_path / 'file' / 'cache'))
    assert not disk_cache.save('name', CODE)
    assert disk_cache.load('name') is None


def test_the_folder_follows_the_xdg_convention(monkeypatch):
    monkeypatch.delenv('DYNAMICS_NODE_CACHE_DIR')
    monkeypatch.setenv('XDG_CACHE_HOME', '/somewhere')
    assert str(disk_cache.folder()) == '/somewhere/dynamics_node'
    monkeypatch.delenv('XDG_CACHE_HOME')
    monkeypatch.setenv('HOME', '/home/me')
    assert str(disk_cache.folder()) == '/home/me/.cache/dynamics_node'


def test_the_key_depends_on_the_robot_but_not_on_gravity():
    arm, pendulum = (RobotModel.from_urdf(path).tree for path in (ARM7, PENDULUM))
    key = disk_cache.key(pack(arm, (0.0, 0.0, -9.81)))
    assert key == disk_cache.key(pack(arm, (1.0, 2.0, 3.0)))
    assert key != disk_cache.key(pack(pendulum, (0.0, 0.0, -9.81)))
    heavier = RobotModel.from_urdf(ARM7.read_text().replace('mass value="', 'mass value="1')).tree
    assert key != disk_cache.key(pack(heavier, (0.0, 0.0, -9.81)))


def test_the_key_of_the_payload_variant_leaves_out_all_inertia():
    arm = RobotModel.from_urdf(ARM7)
    own = pack(arm.tree, arm.gravity)
    variant = own.with_payload_code()
    key = disk_cache.key(variant)
    assert key != disk_cache.key(own)
    for column in range(recursive.WIDTH):
        other = own.numbers.copy()
        other[3, column] += 1.0
        is_input = recursive.INERTIA <= column < recursive.MULTIPLIER or column == recursive.ROTOR
        assert (disk_cache.key(replace(variant, numbers=other)) == key) == is_input
        assert disk_cache.key(replace(own, numbers=other)) != disk_cache.key(own)
    structure = own.structure.copy()
    structure[-1] += 1
    assert disk_cache.key(replace(variant, structure=structure)) != key
