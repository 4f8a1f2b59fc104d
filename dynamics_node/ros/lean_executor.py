"""An executor for one thread that keeps what it waits for from one wait to the next."""

from contextlib import ExitStack

from rclpy.executors import Executor, ExternalShutdownException, ShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.utilities import timeout_sec_to_nsec
from rclpy.waitable import NumberOfEntities


class LeanExecutor(Executor):
    """
    Does what `rclpy.executors.SingleThreadedExecutor` does, for a fraction of its cost.

    rclpy collects all subscriptions, timers and services anew for every wait, and waits twice
    for every message. This one collects them when some were created or destroyed. It takes and
    calls by rclpy's own functions, and rests on names inside rclpy that Jazzy has; where one is
    missing, it refuses to be made.

    Callback groups are not asked: one thread never runs two callbacks at a time. So a callback
    must not await anything.

    """

    def __init__(self, *, context=None):
        """
        Make an executor without nodes.

        Parameters
        ----------
        context : rclpy.Context, optional

        Raises
        ------
        NotImplementedError
            If rclpy is not as this executor knows it.

        """
        super().__init__(context=context)
        takes = ('_take_subscription', '_take_timer', '_take_service', '_take_client',
                 '_take_guard_condition', '_take_waitable', '_guard', '_sigint_gc', '_context')
        missing = [name for name in takes if not hasattr(self, name)]
        if missing:
            raise NotImplementedError(f'expected an executor of rclpy 7.1 (Jazzy), got one '
                                      f'without {", ".join(missing)}')
        self._is_stale = True
        self._in_use = ExitStack()

    def wake(self):
        """End the wait, because entities were created or destroyed."""
        self._is_stale = True
        super().wake()

    def add_node(self, node):
        """Take care of a node from now on; see `rclpy.executors.Executor`."""
        self._is_stale = True
        return super().add_node(node)

    def remove_node(self, node):
        """Take care of a node no longer; see `rclpy.executors.Executor`."""
        super().remove_node(node)
        self._release()

    def shutdown(self, timeout_sec=None):
        """Let go of everything; see `rclpy.executors.Executor`."""
        self._release()
        return super().shutdown(timeout_sec)

    def spin_once(self, timeout_sec=None):
        """
        Wait until something is ready, then call everything that is, once.

        Parameters
        ----------
        timeout_sec : float, optional
            Longest wait, s; None waits as long as it takes.

        Raises
        ------
        ExternalShutdownException
            If the context was shut down.
        ShutdownException
            If this executor was.
        Exception
            Whatever a callback raises; what is ready besides is called next time.

        """
        self._check()
        if self._is_stale:
            try:
                self._collect()
            except BaseException:
                self._release()
                raise
        wait_set = self._wait_set
        wait_set.clear_entities()
        for add, handle in self._handles:
            add(handle)
        for waitable in self._waitables:
            waitable.add_to_wait_set(wait_set)
        wait_set.wait(timeout_sec_to_nsec(timeout_sec))
        self._check()
        for kind, entities, take in self._kinds:
            for pointer in wait_set.get_ready_entities(kind):
                if pointer in entities:
                    _run(take(entities[pointer]))
        for waitable in self._waitables:
            if waitable.is_ready(wait_set):
                _run(self._take_waitable(waitable))
        self._run_tasks()

    def _check(self):
        if self._is_shutdown:
            raise ShutdownException
        if not self._context.ok():
            raise ExternalShutdownException

    def _collect(self):
        self._release()
        # Before the lists are read: what changes from now on is collected next time.
        self._is_stale = False
        nodes = self.get_nodes()

        def of_all(name):
            return [entity for node in nodes for entity in getattr(node, name)]
        groups = {
            'subscription': (of_all('subscriptions'), self._take_subscription),
            'timer': (of_all('timers'), self._take_due_timer),
            'guard_condition': (of_all('guards'), self._take_guard_condition),
            'client': (of_all('clients'), self._take_client),
            'service': (of_all('services'), self._take_service)}
        self._waitables = of_all('waitables')
        waking = [self._guard.handle, self._sigint_gc.handle]
        # In use as long as they are waited for: what is destroyed goes at the next collection.
        for entity in (*self._waitables, self._context.handle, *waking,
                       *(entity.handle for entities, _ in groups.values()
                         for entity in entities)):
            self._in_use.enter_context(entity)
        count = sum((waitable.get_num_entities() for waitable in self._waitables),
                    NumberOfEntities(*(len(groups[kind][0]) for kind in (
                        'subscription', 'guard_condition', 'timer', 'client', 'service'))))
        self._wait_set = _rclpy.WaitSet(
            count.num_subscriptions, count.num_guard_conditions + len(waking), count.num_timers,
            count.num_clients, count.num_services, count.num_events, self._context.handle)
        self._handles = [(getattr(self._wait_set, f'add_{kind}'), entity.handle)
                         for kind, (entities, _) in groups.items() for entity in entities]
        self._handles += [(self._wait_set.add_guard_condition, handle) for handle in waking]
        self._kinds = [(kind, {entity.handle.pointer: entity for entity in entities}, take)
                       for kind, (entities, take) in groups.items() if entities]

    def _take_due_timer(self, timer):
        # A timer that was cancelled or reset after the wait is reported ready all the same.
        return self._take_timer(timer) if timer.handle.is_timer_ready() else None

    def _run_tasks(self):
        if not self._tasks:
            return
        with self._tasks_lock:
            tasks, self._tasks = self._tasks, []
        for task, _, _ in tasks:
            task()
            if task.exception() is not None:
                raise task.exception()
        with self._tasks_lock:
            self._tasks += [item for item in tasks if not item[0].done()]

    def _release(self):
        self._is_stale = True
        self._in_use.close()


def _run(call):
    # What rclpy takes is an async function, which here never waits for anything.
    if call is None:
        return
    coroutine = call()
    try:
        coroutine.send(None)
    except StopIteration:
        return
    coroutine.close()
    raise NotImplementedError('expected callbacks that do not await, got one that does')
