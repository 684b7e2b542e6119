"""A real browser for the tests of reports: finds elements by role and name, clicks, presses keys, reads logs."""
import json
import os
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By

WIDTH, HEIGHT = 1280, 800
# Drawing by software gives the same on every machine, and putting pages together without the emulated processor of graphics takes
# two thirds of the time. The sandbox is off because containers refuse it; the pages are ours.
ARGUMENTS = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--disable-gpu-compositing", "--disable-dev-shm-usage", "--no-first-run", "--disable-extensions",
             "--disable-background-networking", "--disable-component-update", "--force-color-profile=srgb", f"--window-size={WIDTH},{HEIGHT}"]
BAD_LEVELS = {"WARNING", "SEVERE"}
# What the browser says of the pages that it puts together like that.
OWN_WARNING = "GPU stall due to ReadPixels"
# Reads a table: a cell that spans rows counts in each of them, and hidden rows are left out.
CELLS = """
const contentOf = (cell) => {
  const exact = cell.dataset.value;
  return exact === undefined || exact.trim() === '' || Number.isNaN(Number(exact)) ? cell.textContent.trim() : Number(exact);
};
const cellsOf = (table) => {
  const rows = [], spanning = [];
  for (const row of table.rows) {
    if (row.getAttribute('aria-hidden') === 'true') continue;
    const cells = [...row.cells], out = [];
    for (let column = 0; cells.length > 0 || spanning[column]?.rows > 0; column++) {
      if (spanning[column]?.rows > 0) spanning[column].rows--;
      else {
        const cell = cells.shift();
        spanning[column] = {rows: cell.rowSpan - 1, content: contentOf(cell)};
      }
      out.push(spanning[column].content);
    }
    rows.push(out);
  }
  return rows;
};
"""


class Failure(AssertionError):
    """A fault that a scenario found."""


def expect(condition, text):
    if not condition:
        raise Failure(text)


def expect_equal(found, expected, what):
    expect(found == expected, f"{what}: {found!r}, not {expected!r}")


class Page:
    """One browser that opens report after report."""

    def __init__(self):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for argument in ARGUMENTS:
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(30)
        self.path = None
        self.command("Accessibility.enable")

    def close(self):
        self.driver.quit()

    def command(self, name, **arguments):
        """Sends a command of the browser's own protocol."""
        return self.driver.execute_cdp_cmd(name, arguments)

    # Opening

    def resize(self, width=WIDTH, height=HEIGHT, ratio=1):
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio,
                     mobile=False)

    def prefer(self, theme):
        """Tells the page whether the system prefers light or dark."""
        self.command("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])

    def open(self, path, width=WIDTH, height=HEIGHT, ratio=1, theme="light", whole=True, unfold=True):
        """Opens a report, waits until it is drawn or, an incomplete one, has given up, and unfolds all of it."""
        if self.path is not None:
            self.check_quiet()
        self.path = os.path.abspath(path)
        self.resize(width, height, ratio)
        self.prefer(theme)
        self.take_log("browser")
        self.take_log("performance")
        self.driver.get("file://" + self.path)
        error = self.driver.execute_async_script(
            "const done = arguments[0], ready = window.cscd ? window.cscd.ready : Promise.reject('no window.cscd');"
            "ready.then(() => done(null), (error) => done(String(error)));")
        if unfold:
            self.script("document.querySelectorAll('#method, .method-choices').forEach((one) => { one.open = true; });")
        expect((error is None) == whole, f"{self.path}: opening ended with {error}")
        self.settle()

    def forget(self):
        """Skips the check of the log, whose content was expected."""
        self.path = None

    def settle(self):
        """Waits for two pictures, after which everything requested is drawn."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()));")

    def rest(self):
        """Waits until the view is drawn as finely as the screen is; in motion it may be coarser."""
        canvas = self.element("image", "3D view")
        finest = "return arguments[0].width >= Math.floor(arguments[0].clientWidth * devicePixelRatio);"
        self.wait(lambda: self.script(finest, canvas), "the view stays coarse")
        self.settle()

    def wait(self, condition, text, seconds=10.0):
        """Waits until condition() is true, and calls it often."""
        end = time.monotonic() + seconds
        while not condition():
            expect(time.monotonic() < end, f"not within {seconds:g} s: {text}")
            time.sleep(0.02)

    # Logs

    def take_log(self, kind):
        return self.driver.get_log(kind)

    def check_quiet(self):
        """Checks that the console has no warning or error, and that nothing was fetched but the page."""
        bad = [entry["message"] for entry in self.take_log("browser") if entry["level"] in BAD_LEVELS and OWN_WARNING not in entry["message"]]
        expect(not bad, "console: " + "; ".join(bad))
        fetched = []
        for entry in self.take_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                fetched.append(message["params"].get("request", message["params"])["url"])
        others = [url for url in fetched if not url.startswith(("data:", "blob:", "about:"))][1:]
        expect(not others, f"the page asks for {others}")

    # Finding

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def nodes(self, role, name=None):
        """Returns the nodes of the accessibility tree, in the order of the page."""
        document = self.command("DOM.getDocument", depth=0)["root"]["nodeId"]
        arguments = {"nodeId": document, "role": role}
        if name is not None:
            arguments["accessibleName"] = name
        found = self.command("Accessibility.queryAXTree", **arguments)["nodes"]
        return [node for node in found if not node.get("ignored")]

    def element(self, role, name):
        """Returns the one element of that role and name."""
        nodes = self.nodes(role, name)
        expect(len(nodes) == 1, f"{len(nodes)} elements of role {role} are called {name!r}")
        return self.of_node(nodes[0])

    def of_node(self, node):
        handle = self.command("DOM.resolveNode", backendNodeId=node["backendDOMNodeId"])["object"]["objectId"]
        self.command("Runtime.callFunctionOn", objectId=handle,
                     functionDeclaration="function () { window.cscdTestElement = this; }")
        return self.script("const element = window.cscdTestElement; delete window.cscdTestElement; return element;")

    def has(self, role, name):
        return len(self.nodes(role, name)) > 0

    def state(self, key=None):
        """Returns the page's own state, or one part of it."""
        return self.script("const state = window.cscd.store.get(); return arguments[0] ? state[arguments[0]] : state;",
                           key)

    def frame(self):
        return self.state("time")

    # Acting

    def click(self, role, name):
        element = self.element(role, name)
        self.script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'});", element)
        self.settle()
        element.click()
        self.settle()
        return element

    def click_at(self, element, x, y):
        """Clicks at a fraction of the element's width and height."""
        self.script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'});", element)
        self.settle()
        size = element.rect
        actions = ActionChains(self.driver, duration=20)
        actions.move_to_element_with_offset(element, round((x - 0.5) * size["width"]), round((y - 0.5) * size["height"]))
        actions.click().perform()
        self.settle()

    def press(self, *keys):
        """Sends keys to the element that has the focus; a tuple is a key after those that are held down with it."""
        for key in keys:
            actions = ActionChains(self.driver)
            *held, last = key if isinstance(key, tuple) else (key, )
            for modifier in held:
                actions.key_down(modifier)
            actions.send_keys(last)
            for modifier in held:
                actions.key_up(modifier)
            actions.perform()
        self.settle()

    def leave_controls(self):
        """Takes the focus away from any control, as a click on the page's ground does."""
        self.script("if (document.activeElement) document.activeElement.blur(); window.scrollTo(0, 0);")

    def set_box(self, name, wanted):
        """Ticks or clears a box by a click."""
        box = self.element("checkbox", name)
        if box.is_selected() != wanted:
            self.click("checkbox", name)
        expect_equal(self.element("checkbox", name).is_selected(), wanted, f"box {name}")

    def go_to(self, time_of_recording):
        """Shows a moment at once, for scenarios that are not about the controls."""
        self.script("window.cscd.store.set({playing: false, time: arguments[0]});", time_of_recording)
        self.settle()

    # Reading

    def open_ms(self):
        """Returns the time from the start of the navigation to the first picture."""
        return self.script("return performance.getEntriesByName('cscd-open')[0]?.startTime ?? -1;")

    def status(self):
        nodes = self.nodes("status")
        expect(len(nodes) >= 1, "no status line")
        return self.of_node(nodes[0]).text

    def table(self, name):
        """Returns the rows of a table, the header first: the text of each cell, or its exact number if it has one."""
        return self.script(CELLS + "return cellsOf(arguments[0]);", self.element("table", name))

    def markers(self):
        return self.script("return window.cscd.markers();")

    def view_box(self):
        """Returns left, top, width and height of the 3D view in pixels of the page."""
        box = self.script("const r = arguments[0].getBoundingClientRect(); return [r.left, r.top, r.width, r.height];",
                          self.element("image", "3D view"))
        return tuple(box)

    def find_all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)
