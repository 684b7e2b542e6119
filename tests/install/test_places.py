"""make install and make uninstall with names of any kind, and among folders that somebody else made."""
import shlex

from support.install.built_tree import CC, ROOT, make, shell


def test_quotes_in_prefix(tmp_path):
    """Every character that a shell, make, sed or pkg-config takes for its own; make wants a dollar twice."""
    name = "it's \"a\" $b & c|d\\e;f `g` *"
    variables = ("PREFIX=/opt/" + name.replace("$", "$$"),)
    place = tmp_path / "quotes"
    prefix = place / "opt" / name
    make("install", place, *variables)
    assert (prefix / "include/cscd/cscd.h").read_bytes() == (ROOT / "include/cscd/cscd.h").read_bytes()
    # What pkg-config says is for a shell; it leaves the dollar to its reader. DESTDIR is not part of it.
    flags = shell("pkg-config --cflags cscd", PKG_CONFIG_PATH=f"{prefix}/lib/pkgconfig").strip().replace("$", "\\$")
    assert shell(f"printf '%s\\n' {flags}") == f"-I/opt/{name}/include\n"
    assert shell(f"{shlex.quote(str(prefix / 'bin/cscd'))} --version").startswith("cscd ")
    make("uninstall", place, *variables)
    assert not place.exists()


def test_destdirs_of_somebody_else(tmp_path):
    """DESTDIR was there before, or was made anew after somebody removed it: uninstall takes what install made, and nothing else.

    Two installations from one build, one DESTDIR written in two ways, and headers in a folder with a blank.
    """
    variables = ("PREFIX=/usr", "INCLUDEDIR=/usr/my headers")
    first, second, old = (tmp_path / name for name in ("first", "second", "old"))
    first.mkdir()
    make("install-library", first, *variables)
    make("install-library", f"{tmp_path}/./second/", *variables)
    flags = shell("pkg-config --cflags cscd", PKG_CONFIG_PATH=f"{first}/usr/lib/pkgconfig").strip()
    shell(f"echo '#include <cscd/cscd.h>' | {CC} {flags} -fsyntax-only -x c -")
    make("uninstall", first, *variables)
    assert list(first.iterdir()) == []
    assert (second / "usr/lib/libcscd.a").is_file() and (second / "usr/my headers/cscd/cscd.h").is_file()
    second.rename(old)
    (second / "usr/lib").mkdir(parents=True)
    make("uninstall", second, *variables)
    assert sorted(second.rglob("*")) == [second / "usr", second / "usr/lib"]
    # The same folders under their name again: these go.
    (second / "usr/lib").rmdir()
    (second / "usr").rmdir()
    second.rmdir()
    old.rename(second)
    make("uninstall", second, *variables)
    assert not second.exists()
