"""Pictures of the page as the screen would show it, which the browser takes and compares; some are saved."""
import base64
import os

# A picture is kept in the page under a number; the page's own code knows nothing of it. createImageBitmap takes bytes,
# which no content policy forbids.
KEEP = """
const [base64, name, done] = arguments;
const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
createImageBitmap(new Blob([bytes], {type: 'image/png'})).then((bitmap) => {
  const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d', {willReadFrequently: true});
  context.drawImage(bitmap, 0, 0);
  (window.testPictures ??= {})[name] = context.getImageData(0, 0, bitmap.width, bitmap.height);
  done([bitmap.width, bitmap.height]);
});
"""
# Counts the pixels of which a channel differs by more than `least`, in all and within `radius` of each place.
DIFFERENCE = """
const [one, other, least, places, radius] = arguments;
const a = window.testPictures[one], b = window.testPictures[other];
if (a.width !== b.width || a.height !== b.height) return null;
let all = 0;
const near = places.map(() => 0);
for (let i = 0; i < a.data.length; i += 4) {
  const change = Math.max(...[0, 1, 2].map((k) => Math.abs(a.data[i + k] - b.data[i + k])));
  if (change <= least) continue;
  all++;
  const x = (i / 4) % a.width, y = Math.floor(i / 4 / a.width);
  places.forEach(([px, py], n) => { if (Math.hypot(x + 0.5 - px, y + 0.5 - py) <= radius) near[n]++; });
}
return {all, near, pixels: a.width * a.height};
"""
# Counts the pixels that are near a colour, in the whole picture or within `radius` of each place.
COUNT = """
const [name, colour, tolerance, places, radius] = arguments;
const a = window.testPictures[name];
const like = (x, y) => {
  const i = 4 * (y * a.width + x);
  return [0, 1, 2].every((k) => Math.abs(a.data[i + k] - colour[k]) <= tolerance);
};
const within = (left, top, right, bottom) => {
  let count = 0;
  for (let y = Math.max(0, Math.floor(top)); y < Math.min(a.height, bottom); y++)
    for (let x = Math.max(0, Math.floor(left)); x < Math.min(a.width, right); x++) if (like(x, y)) count++;
  return count;
};
if (places === null) return within(0, 0, a.width, a.height);
return places.map(([x, y]) => within(x - radius, y - radius, x + radius, y + radius));
"""
COLOURS = """
const a = window.testPictures[arguments[0]], seen = new Set();
for (let i = 0; i < a.data.length; i += 4) seen.add((a.data[i] >> 3 << 10) | (a.data[i + 1] >> 3 << 5) | a.data[i + 2] >> 3);
return seen.size;
"""


class Pictures:
    """The pictures of one browser; `folder` keeps those that are saved."""

    def __init__(self, page, folder):
        self.page, self.folder, self.number = page, folder, 0
        os.makedirs(folder, exist_ok=True)

    def whole(self, name):
        """Saves what the window shows."""
        self._save(name, self._capture())

    def view(self, name=None):
        """Keeps the 3D view for comparisons, and saves it when it has a name. Its pixels are those of the page."""
        self.page.script("window.scrollTo(0, 0);")
        self.page.rest()
        left, top, width, height = self.page.view_box()
        data = self._capture({"x": left, "y": top, "width": width, "height": height, "scale": 1})
        if name is not None:
            self._save(name, data)
        self.number += 1
        self.page.driver.execute_async_script(KEEP, data, str(self.number))
        return str(self.number)

    def difference(self, one, other, places=(), radius=8.0, least=6):
        """Returns the number of changed pixels in all, and within the radius of each place (in pixels of the view)."""
        found = self.page.script(DIFFERENCE, one, other, least, [list(place) for place in places], radius)
        if found is None:
            raise AssertionError("the pictures are not of one size")
        return found

    def expect_back(self, start, what):
        """Waits until the view is as in the picture `start`, to the last pixel."""
        self.page.wait(lambda: self.difference(start, self.view(), least=0)["all"] == 0, f"the view as before {what}", 4.0)

    def count(self, picture, colour, tolerance=40):
        """Returns the number of pixels of the colour."""
        return self.page.script(COUNT, picture, list(colour), tolerance, None, 0)

    def count_near(self, picture, colour, places, radius=6.0, tolerance=40):
        """Returns the number of pixels of the colour in a square about each place."""
        return self.page.script(COUNT, picture, list(colour), tolerance, [list(place) for place in places], radius)

    def colours(self, picture):
        """Returns how many colours there are, of 32 steps per channel."""
        return self.page.script(COLOURS, picture)

    def _capture(self, clip=None):
        arguments = {"format": "png", "captureBeyondViewport": False}
        if clip is not None:
            arguments["clip"] = clip
        return self.page.command("Page.captureScreenshot", **arguments)["data"]

    def _save(self, name, data):
        with open(os.path.join(self.folder, name + ".png"), "wb") as file:
            file.write(base64.b64decode(data))
