"""Message accounting: balanced, or by how much not."""

from soak.message_accounting import Account, MessageAccounting


def test_everything_is_accounted_for():
    accounting = MessageAccounting()
    accounting.open(Account(100, 60, 30, 9))  # one was sent before the start of the node
    assert accounting.is_open
    accounting.close(Account(200, 140, 40, 19))
    assert not accounting.is_open
    assert (accounting.sent, accounting.missing, accounting.surplus) == (100, 0, 0)


def test_missing_and_surplus_states_do_not_cancel():
    accounting = MessageAccounting()
    accounting.open(Account(0, 0, 0, 0))
    accounting.close(Account(10, 7, 0, 0))
    accounting.open(Account(10, 7, 0, 0))
    accounting.close(Account(20, 20, 0, 0))
    assert (accounting.sent, accounting.missing, accounting.surplus) == (20, 3, 3)


def test_every_state_while_active_has_a_command():
    accounting = MessageAccounting()
    accounting.diagnosed('STARTING', 10, 3)
    accounting.diagnosed('ACTIVE', 60, 52)
    accounting.diagnosed('ACTIVE', 100, 93)
    accounting.diagnosed('ACTIVE', 200, 193)
    assert (accounting.active, accounting.unanswered) == (140, 0)


def test_a_state_without_a_command_is_found():
    accounting = MessageAccounting()
    accounting.diagnosed('ACTIVE', 60, 52)
    accounting.diagnosed('ACTIVE', 100, 92)
    assert accounting.unanswered == 1


def test_states_while_not_active_are_not_counted():
    accounting = MessageAccounting()
    accounting.diagnosed('ACTIVE', 60, 52)
    accounting.diagnosed('STOPPING', 100, 93)
    accounting.diagnosed('FAULT', 100, 130)
    accounting.diagnosed('STARTING', 300, 130)
    accounting.diagnosed('ACTIVE', 400, 230)
    accounting.diagnosed('ACTIVE', 500, 331)
    assert (accounting.active, accounting.unanswered) == (100, 0)
