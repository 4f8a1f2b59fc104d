"""The page in a real browser: complete, without requests, safe with hostile names."""

import json
import math
import re

from dynamics_node import RobotModel
from dynamics_node.report.html import page
from dynamics_node.report.html.plots import LONGEST
from dynamics_node.report.html.scene import scene
from matplotlib.image import imread
import numpy as np
import pytest
from support.browser import browser
from support.hostile_robot import hostile_urdf
from support.report_pages import arm7_report, hostile_report, refused_report, weak_report
from support.robots import ARM7, random_state, random_urdf

PLOTS = (
    'plot-arm',
    'plot-worst',
    'plot-distribution',
    'plot-curve',
    'plot-histogram',
    'plot-mass',
)


@pytest.fixture(scope='module')
def pages(tmp_path_factory):
    """Return the paths of pages by name, some with the policy taken out of them."""
    folder, paths = tmp_path_factory.mktemp('pages'), {}
    for name, report in (
        ('arm7', arm7_report),
        ('weak', weak_report),
        ('refused', refused_report),
        ('hostile', hostile_report),
    ):
        text = page(report())
        unguarded = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>\n', '', text)
        assert len(unguarded) < len(text)
        for kind, markup in ((name, text), (f'{name} unguarded', unguarded)):
            paths[kind] = folder / f'{kind.replace(" ", "-")}.html'
            paths[kind].write_text(markup, encoding='utf-8')
    return paths


@pytest.fixture(scope='module')
def tab(pages):
    """Return a tab with the page of the arm, in three dimensions."""
    with browser() as tab:
        tab.open(pages['arm7'])
        tab.settle()
        yield tab


@pytest.fixture(scope='module')
def flat_tab():
    """Return a tab of a browser without WebGL: quick, and a case of its own."""
    with browser(has_3d=False) as tab:
        yield tab


def count(tab, selector):
    return tab.evaluate(f'document.querySelectorAll({json.dumps(selector)}).length')


def texts(tab, selector):
    return tab.evaluate(
        f'[...document.querySelectorAll({json.dumps(selector)})].map((one) => one.textContent)'
    )


def of_arm7():
    report = arm7_report()
    loads = {joint.name: joint for joint in report.joints}
    return report, [loads[name] for name in report.joint_names]


def test_every_plot_is_drawn_with_everything_in_it(tab):
    report, joints = of_arm7()
    assert tab.evaluate('document.documentElement.dataset.drawn') == 'yes'
    for plot in PLOTS:
        assert count(tab, f'#{plot} svg.main-svg') >= 2, plot
    assert count(tab, '#plot-worst .bars .point path') == len(joints)
    assert count(tab, '#plot-mass .bars .point path') == len(report.bodies)
    assert count(tab, '#plot-distribution .boxes path.box') == len(joints)
    first = tab.evaluate('Number(document.getElementById("joint-choice").value)')
    assert count(tab, '#plot-histogram .bars .point path') == len(joints[first].gravity.counts)
    assert count(tab, '#plot-curve .scatterlayer .js-line') == 1
    assert count(tab, '#plot-curve .scatterlayer .point') == 1
    assert count(tab, '#arm-rows .row') == len(joints)
    labels = texts(tab, '#plot-worst .ytick text')
    assert labels == [joint.name for joint in joints]


def test_nothing_is_requested_and_there_are_no_errors(tab, pages):
    assert tab.requests == [pages['arm7'].as_uri()]
    assert tab.complaints == []
    # Plotly has a button that sends a chart to its makers.
    assert 'Share' not in ' '.join(
        tab.evaluate(
            '[...document.querySelectorAll(".modebar-btn")].map((one) => one.dataset.title)'
        )
    )


def test_a_request_of_a_page_would_be_noticed(flat_tab, pages, tmp_path):
    planted = '<img src="https://example.invalid/planted.png">'
    for kind, is_blocked in (('refused', True), ('refused unguarded', False)):
        path = tmp_path / 'planted.html'
        path.write_text(pages[kind].read_text().replace('<main>', f'<main>{planted}', 1))
        flat_tab.open(path)
        flat_tab.settle()
        assert flat_tab.requests == [path.as_uri(), 'https://example.invalid/planted.png']
        assert flat_tab.blocked == flat_tab.requests[1:] * is_blocked
        assert flat_tab.complaints


def test_the_picture_is_not_blank_light_and_dark(tab, pages, tmp_path):
    shades = {}
    for scheme in ('light', 'dark'):
        tab.scheme(scheme)
        tab.evaluate(
            "document.getElementById('arm-section').scrollIntoView({behavior: 'instant'})"
        )
        tab.settle()
        tab.screenshot(tmp_path / 'page.png')
        picture = imread(tmp_path / 'page.png')[..., :3]
        assert picture.shape == (900, 1280, 3)
        shades[scheme] = np.median(picture)
        box = tab.evaluate(
            '(() => { const b = document.getElementById("plot-arm")'
            '.getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()'
        )
        x, y, width, height = map(int, box)
        view = picture[max(y, 0) : y + height, x : x + width]
        # The balls are the only things in there that are orange.
        is_orange = (view[..., 0] > 1.5 * view[..., 2]) & (view[..., 0] > 0.3)
        assert is_orange.mean() > 0.001, f'{scheme}: no mass is drawn'
    tab.scheme('light')
    assert shades['light'] > 0.9 and shades['dark'] < 0.2


def test_a_plot_has_the_colors_of_dark_and_light(flat_tab, pages):
    flat_tab.show(pages['arm7'])
    fills = {}
    for scheme in ('light', 'dark', 'light'):
        flat_tab.scheme(scheme)
        flat_tab.settle()
        fills.setdefault(scheme, []).append(
            flat_tab.evaluate(
                'getComputedStyle(document.querySelector("#plot-worst .ytick text")).fill'
            )
        )
    assert fills['light'][0] == fills['light'][1] != fills['dark'][0]


def test_the_page_fits_its_window_opened_in_it_or_made_narrow(flat_tab, pages):
    flat_tab.open(pages['weak'], width=320)
    for width in (320, 1280, 820, 390):
        flat_tab.resize(width)
        for plot in PLOTS[1:]:
            flat_tab.wait_for(
                f'(({{ clientWidth, _fullLayout }}) => clientWidth > 0 && '
                f'Math.abs(clientWidth - _fullLayout.width) < 1)'
                f'(document.getElementById("{plot}"))'
            )
        assert flat_tab.evaluate('document.documentElement.scrollWidth') <= width
    flat_tab.resize(1280)


def shown_torques(flat_tab):
    return [
        float(text.split('\u00a0')[0].replace('−', '-').split(' ')[0])
        for text in texts(flat_tab, '#arm-rows .torque')
    ]


def test_a_slider_shows_the_gravity_torque_of_the_model(flat_tab, pages):
    report, _ = of_arm7()
    q = np.random.default_rng(7).uniform(*np.clip(report.model.position_limits, -3, 3).T)
    flat_tab.show(pages['arm7'])
    for place, value in enumerate(q.tolist()):
        flat_tab.evaluate(
            f'(() => {{ const one = document.querySelectorAll("#arm-rows input")[{place}];'
            f'one.value = {value!r}; one.dispatchEvent(new Event("input")); }})()'
        )
    expected = report.model.gravity_torque(q)
    # Three digits are shown.
    np.testing.assert_allclose(shown_torques(flat_tab), expected, rtol=0.006, atol=1e-6)
    assert 'your own' in texts(flat_tab, '#arm-caption')[0]


def test_the_name_of_a_joint_leads_to_its_worst_pose(flat_tab, pages):
    _, joints = of_arm7()
    flat_tab.show(pages['arm7'])
    for place, joint in enumerate(joints):
        flat_tab.evaluate(f'document.querySelectorAll("#arm-rows button")[{place}].click()')
        assert shown_torques(flat_tab)[place] == pytest.approx(
            joint.gravity.worst, rel=0.006, abs=1e-6
        )
        assert joint.name in texts(flat_tab, '#arm-caption')[0]
        # The curve goes with it.
        assert flat_tab.evaluate('document.getElementById("plot-curve").data[1].y') == [
            joint.gravity.worst
        ]
        assert count(flat_tab, '#arm-rows .row.chosen') == 1


def test_the_choice_of_a_joint_leads_there_too(flat_tab, pages):
    _, joints = of_arm7()
    flat_tab.show(pages['arm7'])
    flat_tab.evaluate(
        '(() => { const one = document.getElementById("joint-choice"); one.value ='
        ' "3"; one.dispatchEvent(new Event("change")); })()'
    )
    assert joints[3].name in texts(flat_tab, '#arm-caption')[0]
    assert flat_tab.evaluate('document.getElementById("plot-curve").data[0].name') == (
        joints[3].name
    )


@pytest.mark.parametrize('source', [ARM7, *(random_urdf(seed) for seed in range(4))])
def test_poses_and_torques_of_the_page_are_those_of_the_model(flat_tab, pages, source):
    flat_tab.show(pages['arm7'])
    model = RobotModel.from_urdf(source).with_gravity((0.3, -2.0, -9.5))
    robot, rng = json.dumps(scene(model)), np.random.default_rng(3)
    children = {
        link.body: name
        for name, link in model.tree.links.items()
        if link.body >= 0 and not (link.placement - np.eye(4)).any()
    }
    for _ in range(3):
        q = random_state(rng, model)[0]
        found = flat_tab.evaluate(
            f'[kinematics.poses({robot}, {q.tolist()}),'
            f' kinematics.gravityTorque({robot}, {q.tolist()})]'
        )
        np.testing.assert_allclose(found[1], model.gravity_torque(q), rtol=1e-9, atol=1e-9)
        for body, link in children.items():
            pose = np.reshape(found[0][body], (3, 4))
            np.testing.assert_allclose(pose, model.link_pose(q, link)[:3], atol=1e-12)


def test_plots_change_from_shares_to_torques(flat_tab, pages):
    _, joints = of_arm7()
    flat_tab.show(pages['arm7'])
    chips = '[data-modes="plot-worst"] button'
    assert texts(flat_tab, chips) == ['share of the limit', 'torque']
    assert 'effort limit' in texts(flat_tab, '#plot-worst .xtitle')[0]
    flat_tab.evaluate(f"document.querySelectorAll('{chips}')[1].click()")
    flat_tab.settle()
    assert 'N m' in texts(flat_tab, '#plot-worst .xtitle')[0]
    assert count(flat_tab, '#plot-worst .bars .point path') == len(joints)
    assert count(flat_tab, '#plot-worst .scatterlayer .point') == len(joints)


def test_a_table_is_sorted_up_and_down_with_what_is_missing_last(flat_tab, pages):
    report, _ = of_arm7()
    flat_tab.show(pages['arm7'])
    column = texts(flat_tab, '#joints thead th .title').index('share of the limit')
    known = {
        joint.name: math.nan if joint.gravity is None else joint.gravity.share
        for joint in report.joints
    }
    # From an order in which the joint without a share is not the last one.
    for _ in range(2):
        flat_tab.evaluate('document.querySelector("#joints thead button").click()')
    assert math.isfinite(known[texts(flat_tab, '#joints tbody th')[-1]])
    for way in (1, -1):
        flat_tab.evaluate(f'document.querySelectorAll("#joints thead button")[{column}].click()')
        names = texts(flat_tab, '#joints tbody th')
        shares = np.array([known[name] for name in names])
        assert np.isnan(shares[-1]) and np.isfinite(shares[:-1]).all()
        assert (way * np.diff(shares[:-1]) >= 0).all()
        assert sorted(names) == sorted(known)


def test_a_table_is_filtered_by_words(flat_tab, pages):
    flat_tab.show(pages['arm7'])
    seen = flat_tab.evaluate(
        '(() => { const field = document.querySelector("#links input[type=search]");'
        'field.value = "FINGER"; field.dispatchEvent(new Event("input"));'
        'return [...document.querySelectorAll("#links tbody tr:not([hidden]) th")]'
        '.map((one) => one.textContent); })()'
    )
    assert seen == [
        link.name for link in arm7_report().links if 'finger' in f'{link.name} {link.carrier}'
    ]
    assert count(flat_tab, '#links tbody tr') == len(arm7_report().links)


def test_findings_are_chosen_by_severity(flat_tab, pages):
    report = refused_report()
    flat_tab.open(pages['refused'])
    flat_tab.evaluate('document.querySelector(".severities [data-severity=problem]").click()')
    texts_of_findings = ' '.join(finding.what for finding in report.findings)
    others = [reason for reason in report.refusals if reason not in texts_of_findings]
    assert count(flat_tab, '.finding:not([hidden])') == report.counts['problem'] + bool(others)
    assert flat_tab.complaints == []


def test_without_webgl_a_sentence_is_there_and_all_else_works(flat_tab, pages):
    flat_tab.show(pages['arm7'])
    flat_tab.settle()
    assert 'WebGL' in texts(flat_tab, '#plot-arm')[0]
    assert flat_tab.evaluate('document.documentElement.dataset.drawn') == 'yes'
    assert count(flat_tab, '#plot-worst .bars .point path') == len(of_arm7()[1])
    assert flat_tab.complaints == []


def test_without_scripts_the_tables_are_there(flat_tab, pages):
    report, _ = of_arm7()
    flat_tab.open(pages['arm7'], scripts=False)
    seen = flat_tab.evaluate('document.body.innerText')
    assert 'need JavaScript' in seen
    for entry in (*report.links, *report.joints):
        assert entry.name in seen.replace('\u200b', '')
    assert count(flat_tab, '.js-plotly-plot') == 0


@pytest.mark.parametrize('kind', ['hostile', 'hostile unguarded'])
def test_hostile_names_have_no_effect(flat_tab, pages, kind):
    _, names = hostile_urdf()
    flat_tab.open(pages[kind])
    flat_tab.settle()
    # Under the mouse, and chosen, too.
    for place in range(len(hostile_report().joint_names)):
        flat_tab.evaluate(f'document.querySelectorAll("#arm-rows button")[{place}].click()')
        for plot in ('plot-worst', 'plot-distribution', 'plot-mass'):
            flat_tab.evaluate(
                f'Plotly.Fx.hover("{plot}", [{{curveNumber: 0, pointNumber: {place}}}])'
            )
    flat_tab.settle()
    assert count(flat_tab, '.hoverlayer .hovertext') > 0
    assert flat_tab.evaluate('document.title') == f'{names["robot"]}: model report'
    assert flat_tab.requests == [pages[kind].as_uri()]
    assert flat_tab.complaints == []
    assert count(flat_tab, 'img, main a, svg a, iframe, main script, b:not(.torque b, dd b)') == 0
    joints = hostile_report().joint_names
    assert texts(flat_tab, '#joint-choice option') == list(joints)
    assert texts(flat_tab, '#arm-rows .name') == list(joints)
    for label, name in zip(texts(flat_tab, '#plot-worst .ytick text'), joints, strict=True):
        assert label == name if len(name) <= LONGEST else label.startswith(name[:8])
