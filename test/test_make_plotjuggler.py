"""config/plotjuggler.xml: written by its script, with topics of the node."""

import importlib.util
from pathlib import Path
from xml.etree import ElementTree

from dynamics_node import RobotModel
import pytest
from support.python_process import run_python
from support.robots import ARM7, PENDULUM
from support.sros2_policy import POLICY, read

ROOT = Path(__file__).parents[1]
SCRIPT = ROOT / 'scripts' / 'make_plotjuggler.py'
COMMITTED = ROOT / 'config' / 'plotjuggler.xml'


@pytest.fixture(scope='module')
def layout():
    """Return the function of the script that makes a layout."""
    spec = importlib.util.spec_from_file_location('make_plotjuggler', SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.layout


def curves(text):
    return [curve.get('name') for curve in ElementTree.fromstring(text.encode()).iter('curve')]


def test_the_committed_file_is_what_the_script_writes(layout):
    assert COMMITTED.read_text() == layout(RobotModel.from_urdf(ARM7).joint_names)


def test_curves_are_efforts_of_the_joints_on_topics_of_the_node():
    joints = RobotModel.from_urdf(ARM7).joint_names
    topics = ('/dynamics_node/gravity_torque', '/dynamics_node/external_torque')
    # As the node publishes them: its policy is held against the running node.
    assert set(topics) <= read(POLICY.read_text()).allowed['publish']
    wanted = {f'{topic}/{joint}/effort' for topic in topics for joint in joints}
    found = curves(COMMITTED.read_text())
    assert set(found) == wanted
    assert len(found) == 2 * len(wanted)  # all together, and joint by joint
    [selected] = ElementTree.parse(COMMITTED).getroot().iter('selected_topics')
    assert selected.get('value').split(';') == list(topics)


def test_it_is_built_as_plotjuggler_reads_it(layout):
    # MainWindow::xmlLoadState, PlotDocker::restoreSplitter and PlotWidget::xmlLoadState.
    for text in (COMMITTED.read_text(), layout(['one']), layout([f'j{i}' for i in range(5)])):
        root = ElementTree.fromstring(text.encode())
        assert root.tag == 'root'
        window = root.find('tabbed_widget')
        assert window.attrib == {'name': 'Main Window', 'parent': 'main_window'}
        tabs = window.findall('Tab')
        assert len(tabs) == 2 and window.find('currentTabIndex').get('index') == '0'
        for tab in tabs:
            [splitter] = tab.find('Container')
            assert_splits(splitter)
        for plot in root.iter('plot'):
            assert plot.get('mode') == 'TimeSeries' and plot.find('range') is not None
            assert all(curve.get('color').startswith('#') for curve in plot.iter('curve'))
            assert len({curve.get('color') for curve in plot.iter('curve')}) == min(
                len(plot.findall('curve')), 8
            )
        plugins = [plugin.get('ID') for plugin in root.find('Plugins')]
        assert plugins == ['ROS2 Topic Subscriber']


def assert_splits(element):
    if element.tag == 'DockArea':
        assert [child.tag for child in element] == ['plot']
        return
    assert element.tag == 'DockSplitter' and element.get('orientation') in ('|', '-')
    assert int(element.get('count')) == len(element) > 0
    sizes = [float(size) for size in element.get('sizes').split(';')]
    assert len(sizes) == len(element) and sum(sizes) == pytest.approx(1.0, abs=1e-5)
    for child in element:
        assert_splits(child)


@pytest.mark.parametrize('namespace', ['left', '/left', '/left/'])
def test_another_robot_in_a_namespace(tmp_path, namespace):
    output = tmp_path / 'layout.xml'
    run = run_python(SCRIPT, PENDULUM, output, '--namespace', namespace)
    assert run.returncode == 0, run.stderr
    assert set(curves(output.read_text())) == {
        f'/left/dynamics_node/{topic}/hinge/effort'
        for topic in ('gravity_torque', 'external_torque')
    }


def test_what_is_no_robot_is_refused(tmp_path):
    output = tmp_path / 'layout.xml'
    run = run_python(SCRIPT, tmp_path / 'none.urdf', output)
    assert run.returncode == 1 and run.stderr.startswith('make_plotjuggler: ')
    assert 'Traceback' not in run.stderr and not output.exists()
