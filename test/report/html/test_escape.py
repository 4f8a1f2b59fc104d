"""Texts of a robot on a page: each place has its own way out, and all are closed."""

from html.parser import HTMLParser
import json

from dynamics_node.report.html.escape import plot_text, script_data, span, text
import pytest
from support.hostile_robot import NAMES


class Reader(HTMLParser):
    """What a browser makes of markup."""

    def __init__(self, markup):
        super().__init__()
        self.tags, self.data, self.attributes = [], '', []
        self.feed(markup)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes.extend(attrs)

    def handle_data(self, data):
        self.data += data


@pytest.mark.parametrize('name', NAMES)
def test_a_name_is_text_in_an_element_and_in_an_attribute(name):
    seen = Reader(f'<p title="{text(name)}">{text(name)}</p>')
    assert (seen.tags, seen.data, seen.attributes) == (['p'], name, [('title', name)])


@pytest.mark.parametrize('name', [*NAMES, 'left_arm/tool_0'])
def test_a_name_may_be_broken_into_lines_and_stays_what_it_is(name):
    seen = Reader(span(name))
    assert seen.data == name
    assert set(seen.tags) <= {'span', 'wbr'} and seen.tags.count('span') == 1


@pytest.mark.parametrize('name', NAMES)
def test_data_cannot_end_its_script_element(name):
    data = script_data({'name': name, name: [name]})
    assert not set('<>&\u2028\u2029') & set(data)
    assert json.loads(data) == {'name': name, name: [name]}


def test_data_without_a_number_is_refused():
    with pytest.raises(ValueError, match='JSON compliant'):
        script_data([float('nan')])


@pytest.mark.parametrize('name', NAMES)
def test_a_label_of_a_plot_has_neither_tags_nor_templates(name):
    label = plot_text(name)
    assert not set('<>{}') & set(label)
    assert Reader(label).data == name
