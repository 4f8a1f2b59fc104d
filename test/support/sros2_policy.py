"""Reader of SROS2 policy files (sros2 0.13, schema 0.2.0), with stricter checks."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

# Schema of a profile: element of a rule → its items and permissions.
RULES = {
    'topics': ('topic', {'publish', 'subscribe'}),
    'services': ('service', {'reply', 'request'}),
    'actions': ('action', {'call', 'execute'}),
}
POLICY = Path(__file__).parents[2] / 'config' / 'sros2_policy.xml'


class PolicyError(ValueError):
    """The file is not a policy of one node; the message contains the element."""


@dataclass(frozen=True)
class Profile:
    """
    The permissions of one node.

    Attributes
    ----------
    enclave, namespace, node : str
    allowed : dict of str to set of str
        Permission ('publish', 'subscribe', 'reply', 'request') → full names.

    """

    enclave: str
    namespace: str
    node: str
    allowed: dict


def read(text, namespace=None):
    """
    Return the one profile of a policy.

    Parameters
    ----------
    text : str
    namespace : str, optional
        Replaces the one in the file.

    Raises
    ------
    PolicyError
        If sros2 would refuse it, or if it contains repeated rules, wildcards or denials.

    """
    root = ElementTree.fromstring(text)
    _check(root.tag == 'policy' and root.attrib == {'version': '0.2.0'}, root)
    enclave = _only_child(_only_child(root, 'enclaves'), 'enclave')
    _check(set(enclave.attrib) == {'path'} and enclave.get('path').startswith('/'), enclave)
    profile = _only_child(_only_child(enclave, 'profiles'), 'profile')
    _check(set(profile.attrib) == {'ns', 'node'}, profile)
    node, namespace = profile.get('node'), namespace or profile.get('ns')
    allowed: dict = {}
    for rule in profile:
        _check(rule.tag in RULES and len(rule) > 0 and len(rule.attrib) == 1, rule)
        item_tag, permissions = RULES[rule.tag]
        [(permission, qualifier)] = rule.attrib.items()
        _check(permission in permissions and qualifier == 'ALLOW', rule)
        names = allowed.setdefault(permission, set())
        for item in rule:
            _check(item.tag == item_tag and not item.attrib and len(item) == 0, item)
            name = _full_name(item.text or '', namespace, node)
            _check(name not in names and '*' not in name, item)
            names.add(name)
    return Profile(enclave.get('path'), namespace, node, allowed)


def _full_name(name, namespace, node):
    # As in sros2's style sheet for permissions.
    base = namespace.rstrip('/') + '/'
    if name.startswith('/'):
        return name
    if name.startswith('~/'):
        return f'{base}{node}{name[1:]}'
    return base + name


def _only_child(element, tag):
    _check([child.tag for child in element] == [tag], element)
    return element[0]


def _check(holds, element):
    if not holds:
        raise PolicyError(f'<{element.tag}> {element.attrib} {(element.text or "").strip()}')
