"""An SROS2 policy file, read as sros2 0.13 reads it (schema 0.2.0), and checked more strictly."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

# What sros2's schema allows in a profile: element of a rule → its items and its permissions.
RULES = {
    'topics': ('topic', {'publish', 'subscribe'}),
    'services': ('service', {'reply', 'request'}),
    'actions': ('action', {'call', 'execute'}),
}
POLICY = Path(__file__).parents[2] / 'config' / 'sros2_policy.xml'


class PolicyError(ValueError):
    """The file is no policy of one node; the message says where."""


@dataclass(frozen=True)
class Profile:
    """
    What one node may do.

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
        Instead of the one in the file.

    Raises
    ------
    PolicyError
        If sros2 would refuse it, or it has a rule twice, wildcards or denials: this one needs
        none of them.

    """
    root = ElementTree.fromstring(text)
    _demand(root.tag == 'policy' and root.attrib == {'version': '0.2.0'}, root)
    enclave = _only_child(_only_child(root, 'enclaves'), 'enclave')
    _demand(set(enclave.attrib) == {'path'} and enclave.get('path').startswith('/'), enclave)
    profile = _only_child(_only_child(enclave, 'profiles'), 'profile')
    _demand(set(profile.attrib) == {'ns', 'node'}, profile)
    node, namespace = profile.get('node'), namespace or profile.get('ns')
    allowed: dict = {}
    for rule in profile:
        _demand(rule.tag in RULES and len(rule) > 0 and len(rule.attrib) == 1, rule)
        item_tag, permissions = RULES[rule.tag]
        [(permission, qualifier)] = rule.attrib.items()
        _demand(permission in permissions and qualifier == 'ALLOW', rule)
        names = allowed.setdefault(permission, set())
        for item in rule:
            _demand(item.tag == item_tag and not item.attrib and len(item) == 0, item)
            name = _full_name(item.text or '', namespace, node)
            _demand(name not in names and '*' not in name, item)
            names.add(name)
    return Profile(enclave.get('path'), namespace, node, allowed)


def _full_name(name, namespace, node):
    # As the style sheet does that writes the permissions.
    base = namespace.rstrip('/') + '/'
    if name.startswith('/'):
        return name
    if name.startswith('~/'):
        return f'{base}{node}{name[1:]}'
    return base + name


def _only_child(element, tag):
    _demand([child.tag for child in element] == [tag], element)
    return element[0]


def _demand(holds, element):
    if not holds:
        raise PolicyError(f'<{element.tag}> {element.attrib} {(element.text or "").strip()}')
