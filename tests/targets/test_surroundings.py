"""[workspace] of rosimpact.toml: underlays, rosdep rules and an index of one's own are read from disk."""

from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.config import ConfigError

MANIFEST = """<package format="3"><name>{name}</name><version>{version}</version><description>d</description>
<maintainer email="a@example.com">m</maintainer><license>MIT</license>{body}</package>
"""


def workspace(folder: Path, settings: str) -> Path:
    root = folder / "ws"
    package = root / "src" / "arm"
    package.mkdir(parents=True)
    body = "<depend>warehouse_msgs</depend><depend>company-crane-sdk</depend><depend>tf_old</depend>"
    (package / "package.xml").write_text(MANIFEST.format(name="arm", version="1.0.0", body=body))
    (package / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(tf2)\n")
    (root / "rosimpact.toml").write_text("[workspace]\n" + settings)
    return root


def unknown(root: Path, cache: Path) -> set[str]:
    """Dependencies of which the check says that nobody has them."""
    report = check(root, Options(targets=("jazzy",), cache=cache, jobs=1))
    said = ("misspelt-dependency", "unknown-dependency", "unresolvable-key", "unreleased-package")
    return {f.subject for f in report.findings if f.rule in said}


def test_nothing_is_known_of_ones_own_names_without_settings(tmp_path):
    found = unknown(workspace(tmp_path, ""), tmp_path / "cache")
    assert found == {"warehouse_msgs", "company-crane-sdk", "tf_old"}


def test_packages_of_an_underlay_are_there_whether_merged_or_isolated(tmp_path):
    root = workspace(tmp_path, 'underlays = ["../company", "/nowhere/at/all"]\n')
    for name, share in (("warehouse_msgs", "share/warehouse_msgs"), ("tf_old", "tf_old/share/tf_old")):
        manifest = tmp_path / "company" / share / "package.xml"
        manifest.parent.mkdir(parents=True)
        manifest.write_text(MANIFEST.format(name=name, version="2.1.0", body=""))
    assert unknown(root, tmp_path / "cache") == {"company-crane-sdk"}


def test_keys_of_a_rosdep_file_resolve_on_their_operating_system_only(tmp_path):
    root = workspace(tmp_path, 'rosdep_sources = ["rosdep.yaml"]\n')
    (root / "rosdep.yaml").write_text(
        "company-crane-sdk:\n  ubuntu:\n    noble: [libcrane-dev]\nwarehouse_msgs:\n  fedora: [warehouse]\n"
    )
    assert unknown(root, tmp_path / "cache") == {"warehouse_msgs", "tf_old"}


def test_packages_of_an_index_count_as_released_in_its_distros(tmp_path):
    root = workspace(tmp_path, 'index = "../rosdistro/index-v4.yaml"\n')
    own = tmp_path / "rosdistro" / "jazzy"
    own.mkdir(parents=True)
    (own.parent / "index-v4.yaml").write_text(
        "%YAML 1.1\n---\ndistributions:\n  jazzy:\n    distribution: [jazzy/distribution.yaml]\n"
        "    distribution_status: active\n    distribution_type: ros2\n    python_version: 3\ntype: index\nversion: 4\n"
    )
    (own / "distribution.yaml").write_text(
        "%YAML 1.1\n---\nrelease_platforms:\n  ubuntu: [noble]\nrepositories:\n  warehouse:\n    release:\n"
        "      packages: [warehouse_msgs]\n      tags:\n        release: 'release/{package}/{version}'\n"
        "      url: file:///warehouse.git\n      version: 3.0.1-1\ntype: distribution\nversion: 2\n"
    )
    assert unknown(root, tmp_path / "cache") == {"company-crane-sdk", "tf_old"}


def test_an_edited_rosdep_file_is_read_again(tmp_path):
    root = workspace(tmp_path, 'rosdep_sources = ["rosdep.yaml"]\n')
    (root / "rosdep.yaml").write_text("tf_old:\n  ubuntu: [libtf]\n")
    assert "tf_old" not in unknown(root, tmp_path / "cache")
    from rosimpact.impact.targets.distro import surroundings

    surroundings._load_rosdep.cache_clear()  # another run
    (root / "rosdep.yaml").write_text("other:\n  ubuntu: [libtf]\n")
    assert "tf_old" in unknown(root, tmp_path / "cache")


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ('rosdep_sources = ["missing.yaml"]\n', "missing.yaml: cannot be read"),
        ('rosdep_sources = ["https://company/rosdep.yaml"]\n', "is not fetched; download it"),
        ('rosdep_sources = ["rosimpact.toml"]\n', "is no YAML"),
        ('rosdep_sources = ["list.yaml"]\n', "must map rosdep keys"),
        ('index = "https://company/index-v4.yaml"\n', "is not fetched; clone the repository"),
        ('index = "missing/index-v4.yaml"\n', "there is no such file"),
        ('index = "list.yaml"\n', "cannot be read"),
        ('underlays = ["a\\u0000b"]\n', "contains a null byte"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, settings, says):
    root = workspace(tmp_path, settings)
    (root / "list.yaml").write_text("- a\n- b\n")
    with pytest.raises(ConfigError, match=says) as error:
        unknown(root, tmp_path / "cache")
    assert "rosimpact.toml" in str(error.value)


def test_an_address_in_an_index_is_not_fetched(tmp_path):
    root = workspace(tmp_path, 'index = "index-v4.yaml"\n')
    (root / "index-v4.yaml").write_text(
        "distributions:\n  jazzy:\n    distribution: ['http://h/distribution.yaml']\ntype: index\nversion: 4\n"
    )
    with pytest.raises(ConfigError, match="is not fetched"):
        unknown(root, tmp_path / "cache")


@pytest.mark.parametrize("place", ["../rules.yaml", "link.yaml"])
def test_rosdep_rules_outside_of_the_workspace_are_the_users_to_name(tmp_path, place):
    root = workspace(tmp_path, f'rosdep_sources = ["{place}"]\n')
    (tmp_path / "rules.yaml").write_text("tf_old:\n  ubuntu: [libtf]\n")
    (root / "link.yaml").symlink_to("../rules.yaml")
    with pytest.raises(ConfigError, match="lies outside of the workspace"):
        unknown(root, tmp_path / "cache")
    options = Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1, config=root / "rosimpact.toml")
    assert not [f for f in check(root, options).findings if f.subject == "tf_old"]


def test_a_configuration_that_is_a_link_out_of_the_workspace_is_refused(tmp_path):
    root = workspace(tmp_path, "")
    (root / "rosimpact.toml").rename(tmp_path / "other.toml")
    (root / "rosimpact.toml").symlink_to("../other.toml")
    with pytest.raises(ConfigError, match="--follow-links"):
        unknown(root, tmp_path / "cache")
    check(root, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1, follow_links=True))


@pytest.mark.parametrize("setting", ["", 'rosdep_sources = [".git/config"]\n'])
def test_what_lies_in_git_folders_is_not_read_as_configuration(tmp_path, setting):
    """A checkout may keep a token there."""
    root = workspace(tmp_path, setting)
    (root / ".git").mkdir()
    (root / ".git/config").write_text("tf_old:\n  ubuntu: [libtf]\n" if setting else "[workspace]\n")
    if not setting:
        (root / "rosimpact.toml").unlink()
        (root / "rosimpact.toml").symlink_to(".git/config")
    with pytest.raises(ConfigError, match="is not read"):
        unknown(root, tmp_path / "cache")
