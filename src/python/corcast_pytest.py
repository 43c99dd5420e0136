"""A pytest plugin that compares pictures with accepted references: the fixture `assert_picture`.

    def test_front(assert_picture):
        assert_picture(draw(), tier="B")

The wheel of corcast registers it. Elsewhere: pytest -p corcast_pytest.

A picture is one of: the path of an image file; a numpy array; or an object with a method
save(path) or savefig(path), such as a corcast.Image, a picture of Pillow or a figure of matplotlib.
The picture is stored in the folder of the option --pictures, and compared with the reference of the
same name in the folder of the option --references [docs/REFERENCES.md]. The default name is made
from the names of the test file and the test; the argument `name` replaces it. Further keyword
arguments are options of `corcast compare`.

    pytest --accept-pictures 'new lamp'     stores the pictures of all tests that run as references
    [pytest] picture_references = DIR       sets the default of --references in pytest.ini

The plugin runs `corcast compare --serve`. It finds the program in the environment variable CORCAST,
in the wheel, in the build folder of a source tree, or in PATH.
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess

import pytest


def _program():
    here = pathlib.Path(__file__).resolve().parent
    for path in (os.environ.get("CORCAST"), here / "corcast" / "bin" / "corcast",
                 here.parent.parent / "build" / "corcast", shutil.which("corcast")):
        if path and os.access(path, os.X_OK):
            return str(path)
    raise pytest.UsageError("corcast_pytest: the program corcast is not in PATH; set CORCAST to its path")


class Pictures:
    """The state of a pytest session: the folders, the process of `corcast compare --serve`, and
    the names of the pictures that differ."""

    def __init__(self, config):
        given = config.getoption
        root = pathlib.Path(config.rootpath)
        self.references = root / (given("picture_references") or config.getini("picture_references"))
        self.drawn = root / (given("pictures") or config.getini("pictures"))
        self.reason = given("accept_pictures")
        self.failed = []
        self._process = None

    def ask(self, **options):
        """Sends a request to compare the two folders. Returns the answer of `compare --serve`."""
        if self._process is None:
            self.references.mkdir(parents=True, exist_ok=True)
            self._process = subprocess.Popen([_program(), "compare", "--serve"], stdin=subprocess.PIPE,
                                             stdout=subprocess.PIPE, text=True, encoding="utf-8")
        options["reference"] = str(self.references)
        self._process.stdin.write(json.dumps({"operands": [str(self.drawn)], "options": options}) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            raise RuntimeError(f"corcast compare --serve ended with exit status {self._process.wait()}")
        return json.loads(answer)

    def store(self, picture, name):
        """Stores a picture in the folder of pictures. Returns its name with an extension."""
        is_path = isinstance(picture, (str, os.PathLike))
        if not pathlib.PurePath(name).suffix:
            name += pathlib.Path(picture).suffix if is_path else ".png"
        path = self.drawn / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if is_path:
            shutil.copyfile(picture, path)
        elif hasattr(picture, "savefig"):
            picture.savefig(path)
        elif hasattr(picture, "save"):
            picture.save(str(path))
        else:
            import corcast
            corcast.Image.from_array(picture).save(path)
        return name

    def compare(self, name, options):
        """Compares a picture with its reference, or makes it the reference if the session accepts
        pictures. Returns None, or a sentence about the difference or the error."""
        if self.reason:
            answer = self.ask(accept=name, reason=self.reason)
            return answer.get("error")
        options = {key.replace("_", "-"): value for key, value in options.items()}
        answer = self.ask(only=name, **options)
        if "error" in answer:
            return answer["error"]
        if answer["exit_status"] == 0:
            return None
        self.failed.append(name)
        case = answer["result"]["cases"][0]
        words = ["corcast", "compare", "--reference", str(self.references), str(self.drawn),
                 "--accept", name, "--reason"]
        return (f"{name}: {case['state']}: {case['reason']}\n"
                f"to accept it: {' '.join(map(shlex.quote, words))} '...'")

    def write_page(self):
        """Writes an HTML report about the pictures that differ. Returns its path."""
        worker = os.environ.get("PYTEST_XDIST_WORKER", "")
        page = self.drawn / f"report{worker and '-' + worker}.html"
        self.ask(only=",".join(self.failed), html=str(page))
        return page

    def close(self):
        if self._process is not None:
            self._process.stdin.close()
            self._process.wait()
            self._process = None


_key = pytest.StashKey()


def pytest_addoption(parser):
    group = parser.getgroup("corcast", "pictures compared by corcast")
    group.addoption("--references", dest="picture_references", metavar="DIR",
                    help="folder of accepted pictures (default: references)")
    group.addoption("--pictures", metavar="DIR", help="folder for drawn pictures (default: build/pictures)")
    group.addoption("--accept-pictures", metavar="REASON",
                    help="make the pictures of all tests that run their references")
    parser.addini("picture_references", "folder of accepted pictures", default="references")
    parser.addini("pictures", "folder for drawn pictures", default="build/pictures")


def pytest_configure(config):
    config.stash[_key] = Pictures(config)


def pytest_unconfigure(config):
    config.stash[_key].close()


def pytest_terminal_summary(terminalreporter, config):
    pictures = config.stash[_key]
    if pictures.failed:
        terminalreporter.write_line(f"pictures that differ: {pictures.write_page()}")


@pytest.fixture
def assert_picture(request):
    """Compares a picture with its reference. Fails the test if they differ."""
    pictures = request.config.stash[_key]
    base = re.sub(r"[^A-Za-z0-9_.-]", "_", f"{request.node.path.stem}.{request.node.name}")
    n_unnamed = 0

    def check(picture, name=None, **options):
        nonlocal n_unnamed
        if name is None:
            n_unnamed += 1
            # The extension is appended here, because a name with a '.' would count as having one.
            suffix = pathlib.Path(picture).suffix if isinstance(picture, (str, os.PathLike)) else ".png"
            name = base + (f"-{n_unnamed}" if n_unnamed > 1 else "") + suffix
        sentence = pictures.compare(pictures.store(picture, name), options)
        if sentence:
            pytest.fail(sentence, pytrace=False)

    return check
