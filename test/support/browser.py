"""
A real browser without a window: Chromium, told what to do over a pipe.

It is the judge of the pages that the package writes: what is drawn, what runs, what is asked of
the network. DYNAMICS_NODE_BROWSER names one; otherwise it is looked for on the PATH.

"""

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

import pytest

NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
PATIENCE = 120.0  # [s] for one answer; three dimensions without a graphics card take their time

# No service of the browser's maker, no name is ever resolved; 3D by the processor.
_OPTIONS = (
    '--headless',
    '--remote-debugging-pipe',
    '--no-first-run',
    '--disable-sync',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-extensions',
    '--disable-dev-shm-usage',
    '--no-default-browser-check',
    '--mute-audio',
    '--host-resolver-rules=MAP * ~NOTFOUND',
)
_SOFTWARE_3D = ('--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader')
_NO_3D = ('--disable-gpu', '--disable-software-rasterizer', '--disable-3d-apis')


def find_browser():
    """Return the path of a browser, or None."""
    chosen = os.environ.get('DYNAMICS_NODE_BROWSER')
    if chosen:
        return shutil.which(chosen)
    return next(filter(None, map(shutil.which, NAMES)), None)


def require_browser():
    """
    Return the path of a browser; without one the test is skipped.

    With DYNAMICS_NODE_BROWSER_REQUIRED=1, as .ci/run sets it, the test fails.

    """
    path = find_browser()
    if path is None:
        chosen = os.environ.get('DYNAMICS_NODE_BROWSER')
        if chosen:
            pytest.fail(
                f'DYNAMICS_NODE_BROWSER: expected a browser, got {chosen!r}, which is no program'
            )
        said = (
            'no browser found: install chromium (apt-get install chromium), or set '
            'DYNAMICS_NODE_BROWSER to one'
        )
        if os.environ.get('DYNAMICS_NODE_BROWSER_REQUIRED', '') not in ('', '0'):
            pytest.fail(said)
        pytest.skip(said)
    return path


@contextlib.contextmanager
def browser(has_3d=True):
    """Yield a `Tab` of a new browser, which is closed in the end."""
    path = require_browser()
    read_answers, write_answers = os.pipe()
    read_orders, write_orders = os.pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = [*_OPTIONS, *(_SOFTWARE_3D if has_3d else _NO_3D), f'--user-data-dir={profile}']
        if os.geteuid() == 0:
            options.append('--no-sandbox')  # it refuses to be started by root otherwise
        # The browser reads orders from 3 and writes answers to 4.
        process = subprocess.Popen(
            ['bash', '-c', f'exec "$0" "$@" 3<&{read_orders} 4>&{write_answers}', path, *options],
            pass_fds=(read_orders, write_answers),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        os.close(read_orders)
        os.close(write_answers)
        try:
            tab = Tab(write_orders, read_answers)
            yield tab
            tab.order('Browser.close', session=False)
            process.wait(timeout=PATIENCE)
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            os.close(write_orders)
            os.close(read_answers)


class Tab:
    """
    One page, and what came of it.

    Attributes
    ----------
    requests : list of str
        Addresses that the page asked for since `open`, with its own, also in vain.
    blocked : list of str
        Those of them that the page's own policy forbade.
    complaints : list of str
        Errors and warnings of its scripts and of the browser.

    """

    def __init__(self, orders, answers):
        self._orders, self._answers = orders, answers
        self._rest, self._number, self._session = b'', 0, None
        self._results, self._loaded = {}, False
        self.requests, self.blocked, self.complaints = [], [], []
        self._addresses = {}
        target = self.order('Target.createTarget', session=False, url='about:blank')['targetId']
        self._session = self.order(
            'Target.attachToTarget', session=False, targetId=target, flatten=True
        )['sessionId']
        for domain in ('Page', 'Runtime', 'Log', 'Network'):
            self.order(f'{domain}.enable')

    def show(self, path):
        """Open a file unless it is open already."""
        if self.evaluate('location.href') != path.as_uri():
            self.open(path)

    def open(self, path, width=1280, height=900, scheme='light', scripts=True):
        """Open a file, and wait until it is loaded."""
        self.resize(width, height)
        self.order('Emulation.setScriptExecutionDisabled', value=not scripts)
        self.scheme(scheme)
        self.requests.clear()
        self.blocked.clear()
        self.complaints.clear()
        self._loaded = False
        self.order('Page.navigate', url=path.as_uri())
        deadline = time.monotonic() + PATIENCE
        while not self._loaded:
            self._receive(deadline)

    def resize(self, width, height=900):
        """Give the window another size, in pixels."""
        self.order(
            'Emulation.setDeviceMetricsOverride',
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def scheme(self, name):
        """Let the system ask for 'light' or 'dark'."""
        self.order(
            'Emulation.setEmulatedMedia',
            features=[{'name': 'prefers-color-scheme', 'value': name}],
        )

    def evaluate(self, expression):
        """Return what a JavaScript expression gives, a promise's value too."""
        answer = self.order(
            'Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True
        )
        assert 'exceptionDetails' not in answer, answer['exceptionDetails']
        return answer['result'].get('value')

    def wait_for(self, expression):
        """Wait until a JavaScript expression is true."""
        deadline = time.monotonic() + PATIENCE
        while not self.evaluate(expression):
            assert time.monotonic() < deadline, f'not within {PATIENCE:.0f} s: {expression}'
            time.sleep(0.02)

    def settle(self):
        """Wait until everything that was asked for is drawn."""
        self.evaluate(
            'new Promise((done) => requestAnimationFrame(() => '
            'requestAnimationFrame(() => setTimeout(done, 50))))'
        )

    def screenshot(self, path):
        """Write what is seen now as PNG."""
        data = self.order('Page.captureScreenshot', format='png')['data']
        path.write_bytes(base64.b64decode(data))

    def order(self, method, session=True, **parameters):
        """Return the answer to an order of the DevTools protocol."""
        self._number += 1
        message = {'id': self._number, 'method': method, 'params': parameters}
        if session:
            message['sessionId'] = self._session
        os.write(self._orders, json.dumps(message).encode() + b'\0')
        deadline = time.monotonic() + PATIENCE
        while self._number not in self._results:
            self._receive(deadline)
        answer = self._results.pop(self._number)
        assert 'error' not in answer, f'{method}: {answer["error"]}'
        return answer['result']

    def _receive(self, deadline):
        left = deadline - time.monotonic()
        assert left > 0.0 and select.select([self._answers], [], [], left)[0], (
            f'the browser did not answer within {PATIENCE:.0f} s'
        )
        data = os.read(self._answers, 1 << 20)
        assert data, 'the browser has ended'
        *messages, self._rest = (self._rest + data).split(b'\0')
        for message in map(json.loads, messages):
            if 'id' in message:
                self._results[message['id']] = message
            else:
                self._note(message['method'], message['params'])

    def _note(self, event, parameters):
        if event == 'Page.loadEventFired':
            self._loaded = True
        elif event == 'Network.requestWillBeSent':
            address = parameters['request']['url']
            self.requests.append(address)
            self._addresses[parameters['requestId']] = address
        elif event == 'Network.loadingFailed' and parameters.get('blockedReason') == 'csp':
            self.blocked.append(self._addresses[parameters['requestId']])
        elif event == 'Runtime.exceptionThrown':
            self.complaints.append(json.dumps(parameters['exceptionDetails']))
        elif event == 'Runtime.consoleAPICalled' and parameters['type'] in (
            'error',
            'warning',
            'assert',
        ):
            self.complaints.append(json.dumps(parameters['args']))
        elif event == 'Log.entryAdded' and parameters['entry']['level'] == 'error':
            self.complaints.append(json.dumps(parameters['entry']))
