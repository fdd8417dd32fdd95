"""scripts/run-page runs a page as a reader would, and says where the page is wrong."""
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/run-page"
PAGE = """# A page

```text file=one.txt
alpha 1.5 s
beta
gamma
```

```sh
cat one.txt
```

```text expected
alpha … s
…
gamma
```

```sh exit=3
exit 3
```

```console
false
```
"""


class RunPage(unittest.TestCase):
    def run_page(self, text, *options):
        with tempfile.TemporaryDirectory() as work:
            page = Path(work) / "page.md"
            page.write_text(text, encoding="utf-8")
            done = subprocess.run([SCRIPT, *options, page, Path(work) / "folder"], capture_output=True, text=True)
        return done

    def test_a_page_that_is_right_ends_with_0(self):
        done = self.run_page(PAGE)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("$ cat one.txt\nalpha 1.5 s\n", done.stdout)

    def test_the_table_has_a_line_for_each_step(self):
        lines = self.run_page(PAGE, "--table").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ["page.md:9", "page.md:19"])
        self.assertEqual([line.split()[2] for line in lines], ["0", "3"])

    def test_another_text_another_exit_code_and_an_open_fence_are_told_with_their_line(self):
        for wrong, place in ((PAGE.replace("alpha … s", "alpha … m"), "page.md:13: expected"),
                             (PAGE.replace("\n…\ngamma", "\ngamma"), "page.md:13: expected"),
                             (PAGE.replace("gamma\n```\n\n```sh exit", "gamma\ndelta\n```\n\n```sh exit"), "page.md:13: expected"),
                             (PAGE.replace("exit=3", "exit=2"), "page.md:19: ended with 3"),
                             (PAGE + "```sh\ntrue\n", "the fence has no end")):
            done = self.run_page(wrong)
            self.assertEqual(done.returncode, 1, wrong)
            self.assertIn(place, done.stderr)

    def test_what_lies_in_the_folder_is_left_alone(self):
        with tempfile.TemporaryDirectory() as work:
            page = Path(work) / "page.md"
            page.write_text(PAGE, encoding="utf-8")
            done = subprocess.run([SCRIPT, page, work], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn("has content", done.stderr)
            self.assertFalse((Path(work) / "one.txt").exists())


if __name__ == "__main__":
    unittest.main()
