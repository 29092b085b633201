"""What the workspace names is never fetched. A server of this machine, also named as the proxy, must hear nothing."""

from __future__ import annotations

from .harness import COMMANDS, STATUS, Attack, Place, manifest

GROUP = "network"
CHECK = COMMANDS["check"]


def toml(text: str) -> dict[str, str]:
    return {"rosimpact.toml": text}


INDEX = (
    "%YAML 1.1\n---\ndistributions:\n  jazzy:\n    distribution: ['{url}/jazzy.yaml']\n"
    "    distribution_cache: '{url}/cache.gz'\n    distribution_status: active\n    distribution_type: ros2\n"
    "    python_version: 3\ntype: index\nversion: 4\n"
)
PLACES: dict[str, dict[str, str]] = {
    "index": toml("[workspace]\nindex = '{url}/index.yaml'\n"),
    "index of https": toml("[workspace]\nindex = 'https://127.0.0.1:9/index.yaml'\n"),
    "index of another scheme": toml("[workspace]\nindex = 'ftp://127.0.0.1:9/index.yaml'\n"),
    "index with a user": toml("[workspace]\nindex = 'http://user:evil@127.0.0.1:9/index.yaml'\n"),
    "index of metadata of a cloud": toml("[workspace]\nindex = 'http://169.254.169.254/latest/meta-data'\n"),
    "index file that names URLs": {**toml("[workspace]\nindex = 'index.yaml'\n"), "index.yaml": INDEX},
    "rosdep sources": toml("[workspace]\nrosdep_sources = ['{url}/rosdep.yaml']\n"),
    "rosdep list": {
        **toml("[workspace]\nrosdep_sources = ['r.list']\n"),
        "r.list": "yaml {url}/rosdep.yaml\nyaml file://{outside}/secret.txt\n",
    },
    "rosdep yaml that names a URL": {
        **toml("[workspace]\nrosdep_sources = ['r.yaml']\n"),
        "r.yaml": "evil:\n  ubuntu:\n    pip: {packages: ['git+{url}/x']}\n  debian: '{url}/rosdep.rdmanifest'\n",
    },
    "repos": toml("[workspace]\nrepos = ['{url}/x.repos']\n"),
    "repos file of URLs": {
        **toml("[workspace]\nrepos = ['x.repos']\n"),
        "x.repos": "repositories:\n  evil: {type: git, url: '{url}/x.git', version: main}\n",
    },
    "underlays": toml("[workspace]\nunderlays = ['{url}/ws']\n"),
    "target of a file": toml("[targets.x]\nfile = '{url}/machine.json'\n"),
    "target of docker": toml("[targets.x]\ndistro = 'docker:{url}/evil:latest'\n"),
    "gitmodules": {".gitmodules": '[submodule "a"]\n\tpath = src/a\n\turl = {url}/a.git\n'},
    "URLs of a manifest": {
        "src/bad/package.xml": manifest("bad")
        .replace("<export>", "<url type='repository'>{url}/bad</url><export>")
        .replace(
            '<?xml version="1.0"?>', "<?xml version=\"1.0\"?>\n<?xml-model href='{url}/package.xsd' schematypens='x'?>"
        )
    },
    "external DTD": {"src/bad/package.xml": manifest("bad").replace("?>", "?><!DOCTYPE package SYSTEM '{url}/x.dtd'>")},
    "external entity": {
        "src/bad/launch/a.launch": "<!DOCTYPE launch [<!ENTITY % e SYSTEM '{url}/e'> %e; <!ENTITY f SYSTEM "
        "'{url}/f'>]><launch>&f;</launch>"
    },
    "launch file that includes a URL": {
        "src/bad/launch/a.launch.xml": "<launch><include file='{url}/b.launch.xml'/></launch>"
    },
    "parameters of a URL": {
        "src/bad/launch/a.launch.xml": "<launch><node pkg='healthy' exec='healthy_node'><param "
        "from='{url}/p.yaml'/></node></launch>"
    },
    "xacro that includes a URL": {
        "src/bad/urdf/a.urdf.xacro": "<robot xmlns:xacro='x'><xacro:include filename='{url}/a.xacro'/><mesh "
        "filename='{url}/m.stl'/></robot>"
    },
    "CMake that downloads": {
        "src/bad/CMakeLists.txt": "project(bad)\nfile(DOWNLOAD {url}/x x)\ninclude(FetchContent)\n"
        "FetchContent_Declare(x URL {url}/x)\nFetchContent_MakeAvailable(x)\ninclude(ExternalProject)\n"
        "ExternalProject_Add(x GIT_REPOSITORY {url}/x)\n"
    },
    "setup.py of dependency links": {
        "src/bad/setup.py": "from setuptools import setup\nsetup(name='bad', dependency_links=['{url}/x'], "
        "install_requires=['x @ {url}/x.whl'])\n"
    },
    "requirements of URLs": {
        "src/bad/requirements.txt": "-r {url}/r.txt\nx @ {url}/x.whl\n",
        "src/bad/pyproject.toml": "[project]\nname = 'bad'\nversion = '1'\ndependencies = ['x @ {url}/x.whl']\n",
    },
    "colcon mixins": {
        "defaults.yaml": "build:\n  mixin: ['{url}/m']\n  metas: ['{url}/meta']\n  base-paths: ['.', '{url}/x']\n"
    },
    "UNC paths": toml("[workspace]\nunderlays = ['//127.0.0.1/share']\nrepos = ['\\\\127.0.0.1\\share']\n"),
}


def rows() -> list[Attack]:
    found: list[Attack] = []
    for name, files in PLACES.items():
        command = ("check", "{ws}", "-q") if name.startswith("target") else CHECK
        # What the settings ask for and do not get is named, or refused.
        settings = "rosimpact.toml" in files
        found.append(
            Attack(
                f"check: {name}", GROUP, files, command, (0, 1, 2) if settings else (1,), found="" if settings else None
            )
        )
        found.append(
            Attack(
                f"upgrade: {name}",
                GROUP,
                files,
                COMMANDS["upgrade"],
                (0, 1, 2) if settings else (1,),
                found="" if settings else None,
            )
        )
        if settings:
            found.append(Attack(f"why: {name}", GROUP, files, COMMANDS["why"], (0, 1, 2), found=""))
            found.append(Attack(f"env: {name}", GROUP, files, COMMANDS["env"], (0, 1, 2), found=""))
        else:
            found.append(Attack(f"graph: {name}", GROUP, files, COMMANDS["graph"], (STATUS["graph"],)))
    found += [
        Attack(
            "check: a remote of git", GROUP, remote, (*CHECK, "--base", "origin/main"), (0, 1, 2), git=True, found=""
        ),
        Attack(
            "triage of a text with addresses",
            GROUP,
            {"r.txt": "It fails, see {url}/issue and\n{url}/log.txt\n"},
            ("triage", "{ws}/r.txt"),
            (0, 1, 2),
            found="",
            seconds=8,
        ),
        Attack(
            "check: a captured machine with addresses",
            GROUP,
            {"m.json": '{"rosimpact_target": 1, "distro": "humble", "url": "{url}/m", "packages": {}}'},
            ("check", "{ws}", "-t", "{ws}/m.json"),
            (0, 1, 2),
            found="",
        ),
        Attack("check html: nothing is asked", GROUP, {}, (*CHECK, "-f", "html", "-o", "{out}/a.html"), (1,)),
        Attack("installed command: index", GROUP, PLACES["index"], CHECK, (0, 1, 2), found="", direct=True),
    ]
    return found


def remote(place: Place) -> None:
    config = place.ws / ".git/config"
    config.write_text(
        config.read_text()
        + f'[remote "origin"]\n\turl = {place.url}/x.git\n\tfetch = +refs/heads/*:refs/remotes/origin/*\n'
    )
