"""The books balance, or say by how much not."""

from soak.message_accounting import Account, Books


def test_everything_is_accounted_for():
    books = Books()
    books.open(Account(100, 60, 30, 9))  # one was sent before the node was there
    assert books.is_open
    books.close(Account(200, 140, 40, 19))
    assert not books.is_open
    assert (books.sent, books.missing, books.surplus) == (100, 0, 0)


def test_what_is_missing_and_what_is_too_much_do_not_make_up_for_each_other():
    books = Books()
    books.open(Account(0, 0, 0, 0))
    books.close(Account(10, 7, 0, 0))
    books.open(Account(10, 7, 0, 0))
    books.close(Account(20, 20, 0, 0))
    assert (books.sent, books.missing, books.surplus) == (20, 3, 3)


def test_every_state_while_active_has_a_command():
    books = Books()
    books.diagnosed('STARTING', 10, 3)
    books.diagnosed('ACTIVE', 60, 52)
    books.diagnosed('ACTIVE', 100, 93)
    books.diagnosed('ACTIVE', 200, 193)
    assert (books.active, books.unanswered) == (140, 0)


def test_a_state_without_a_command_is_found():
    books = Books()
    books.diagnosed('ACTIVE', 60, 52)
    books.diagnosed('ACTIVE', 100, 92)
    assert books.unanswered == 1


def test_what_is_not_active_has_other_commands():
    books = Books()
    books.diagnosed('ACTIVE', 60, 52)
    books.diagnosed('STOPPING', 100, 93)
    books.diagnosed('FAULT', 100, 130)
    books.diagnosed('STARTING', 300, 130)
    books.diagnosed('ACTIVE', 400, 230)
    books.diagnosed('ACTIVE', 500, 331)
    assert (books.active, books.unanswered) == (100, 0)
