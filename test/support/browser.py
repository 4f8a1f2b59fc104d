"""
A browser without a window, driven by Selenium: Chromium with its chromedriver.

It judges the pages that the package writes: what is drawn, what runs, what is requested from the
network. DYNAMICS_NODE_BROWSER names a browser; otherwise the PATH is searched.

"""

import base64
import contextlib
import json
import os
import shutil
import time

import pytest

NAMES = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
# Longest wait for one answer, s; 3D without a graphics card is slow.
PATIENCE = 120.0

# No services of the browser's vendor, no name resolution.
_OPTIONS = (
    '--headless=new',
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
    Return the paths of a browser and of chromedriver; without them the test is skipped.

    With DYNAMICS_NODE_BROWSER_REQUIRED=1, as .ci/run sets it, the test fails.

    """
    path, driver = find_browser(), shutil.which('chromedriver')
    chosen = os.environ.get('DYNAMICS_NODE_BROWSER')
    if chosen and path is None:
        pytest.fail(
            f'DYNAMICS_NODE_BROWSER: expected a browser, got {chosen!r}, which is no program'
        )
    if path is None or driver is None:
        missing = 'browser' if path is None else 'chromedriver'
        message = (
            f'no {missing} found: install Chromium and its driver '
            '(apt-get install chromium chromium-driver)'
        )
        if os.environ.get('DYNAMICS_NODE_BROWSER_REQUIRED', '') not in ('', '0'):
            pytest.fail(message)
        pytest.skip(message)
    return path, driver


@contextlib.contextmanager
def browser(has_3d=True):
    """Yield a `Tab` of a new browser, which is closed at the end."""
    from selenium import webdriver

    path, driver_path = require_browser()
    options = webdriver.ChromeOptions()
    options.binary_location = path
    for option in (*_OPTIONS, *(_SOFTWARE_3D if has_3d else _NO_3D)):
        options.add_argument(option)
    if os.geteuid() == 0:
        options.add_argument('--no-sandbox')  # Chromium refuses to run as root otherwise
    options.set_capability('goog:loggingPrefs', {'performance': 'ALL', 'browser': 'ALL'})
    with pytest.MonkeyPatch.context() as environment:
        # Selenium talks to the driver over a local port, not by way of the user's proxy.
        environment.setenv('no_proxy', 'localhost')
        # With the path of the driver Selenium does not search or download one.
        driver = webdriver.Chrome(options, webdriver.ChromeService(driver_path))
        try:
            driver.set_page_load_timeout(PATIENCE)
            yield Tab(driver)
        finally:
            driver.quit()


class Tab:
    """
    One page with its requests and errors.

    Attributes
    ----------
    requests : list of str
        Addresses that the page requested since `open`, with its own, successful or not.
    blocked : list of str
        Those of them that the page's own policy forbade.
    complaints : list of str
        Errors and warnings of its scripts and of the browser.

    """

    def __init__(self, driver):
        self._driver = driver
        self._addresses, self._requests, self._blocked, self._complaints = {}, [], [], []

    @property
    def requests(self):
        self._read_logs()
        return list(self._requests)

    @property
    def blocked(self):
        self._read_logs()
        return list(self._blocked)

    @property
    def complaints(self):
        self._read_logs()
        return list(self._complaints)

    def show(self, path):
        """Open a file unless it is open already."""
        if self.evaluate('location.href') != path.as_uri():
            self.open(path)

    def open(self, path, width=1280, height=900, scheme='light', scripts=True):
        """Open a file, and wait until it is loaded."""
        self.resize(width, height)
        self._order('Emulation.setScriptExecutionDisabled', value=not scripts)
        self.scheme(scheme)
        self._read_logs()
        self._requests.clear()
        self._blocked.clear()
        self._complaints.clear()
        self._driver.get(path.as_uri())

    def resize(self, width, height=900):
        """Give the window another size, in pixels."""
        self._order(
            'Emulation.setDeviceMetricsOverride',
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def scheme(self, name):
        """Emulate a system with the color scheme 'light' or 'dark'."""
        self._order(
            'Emulation.setEmulatedMedia',
            features=[{'name': 'prefers-color-scheme', 'value': name}],
        )

    def evaluate(self, expression):
        """Return the value of a JavaScript expression, or of its promise."""
        # Unlike Selenium's execute_script this works in pages whose scripts are disabled.
        answer = self._order(
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
        """Wait until everything is drawn."""
        self.evaluate(
            'new Promise((done) => requestAnimationFrame(() => '
            'requestAnimationFrame(() => setTimeout(done, 50))))'
        )

    def screenshot(self, path):
        """Write the visible part of the page as PNG."""
        data = self._order('Page.captureScreenshot', format='png')['data']
        path.write_bytes(base64.b64decode(data))

    def _order(self, method, **parameters):
        return self._driver.execute_cdp_cmd(method, parameters)

    def _read_logs(self):
        for entry in self._driver.get_log('performance'):
            event = json.loads(entry['message'])['message']
            self._note(event['method'], event['params'])
        self._complaints += [
            entry['message']
            for entry in self._driver.get_log('browser')
            if entry['level'] == 'SEVERE'
            or (entry['level'], entry['source']) == ('WARNING', 'console-api')
        ]

    def _note(self, event, parameters):
        if event == 'Network.requestWillBeSent':
            address = parameters['request']['url']
            self._requests.append(address)
            self._addresses[parameters['requestId']] = address
        elif event == 'Network.loadingFailed' and parameters.get('blockedReason') == 'csp':
            self._blocked.append(self._addresses[parameters['requestId']])
