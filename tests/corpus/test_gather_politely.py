"""The client waits when told to, tries again when that helps, gives up cleanly, and keeps its secrets."""

from __future__ import annotations

import gzip
import io
import logging

import pytest
from rosimpact.corpus.gather import gather
from rosimpact.corpus.polite import Client, Later, StatusError
from rosimpact.corpus.report import CorpusError
from rosimpact.corpus.sources.github import GitHub, Listed, Searched
from rosimpact.corpus.sources.stack_exchange import StackExchange, TaggedQuestions
from rosimpact.corpus.store import CorpusStore
from rosimpact.corpus.tokens import find_github_token, find_stack_exchange_key
from server import Fault, Services, issue, question, stamp
from waiting import Hours

REPO = "ros2/rclcpp"
NOW = 1_700_000_000
SECONDARY = b'{"message": "You have exceeded a secondary rate limit. Please wait a few minutes before you try again."}'
PRIMARY = b'{"message": "API rate limit exceeded for 203.0.113.7."}'
FORBIDDEN = b'{"message": "Resource not accessible by integration"}'


@pytest.fixture
def server():
    services = Services()
    services.issues[REPO] = [issue(REPO, n + 1, day=stamp(1_600_000_000 + n)) for n in range(250)]
    yield services
    services.close()


@pytest.fixture
def store(tmp_path):
    with CorpusStore(tmp_path / "corpus.sqlite") as opened:
        yield opened


def client(clock: Hours, **more) -> Client:
    return Client("GitHub", clock=clock, **{"timeout": 2, **more})


def limits(remaining: int, reset: int) -> dict[str, str]:
    return {"X-RateLimit-Limit": "60", "X-RateLimit-Remaining": str(remaining), "X-RateLimit-Reset": str(reset)}


@pytest.mark.parametrize(
    ("fault", "least", "most"),
    [
        (Fault(403, {"Retry-After": "17"}, SECONDARY), 17, 17),
        (Fault(429, {"Retry-After": "17"}, SECONDARY), 17, 17),
        (Fault(429, {"Retry-After": "Tue, 14 Nov 2023 22:15:20 GMT"}), 120, 120),  # NOW is 22:13:20
        (Fault(403, limits(0, NOW + 300), PRIMARY), 301, 301),
        (Fault(429, limits(0, NOW + 300), PRIMARY), 301, 301),
        (Fault(403, {}, SECONDARY), 60, 75),
        (Fault(403, limits(41, NOW + 300), SECONDARY), 60, 75),
        (Fault(429, {}), 60, 75),
        (Fault(503, {"Retry-After": "9"}), 9, 9),
        (Fault(502, body=b"<html>502 Bad Gateway</html>"), 0.5, 1),
        (Fault(500), 0.5, 1),
        (Fault(part=0.4), 0.5, 1),  # the connection ends in the middle of the body
        (Fault(body=b'[{"number": 1, "ti'), 0.5, 1),  # ended early, but the length was said to be that
        (Fault(body=b"<!DOCTYPE html><title>Unicorn!</title>", headers={"Content-Type": "text/html"}), 0.5, 1),
        (Fault(body=b"\x1f\x8b\x08no gzip", headers={"Content-Encoding": "gzip"}), 0.5, 1),
        (Fault(body=gzip.compress(b"[]" * 1000)[:20], headers={"Content-Encoding": "gzip"}), 0.5, 1),
    ],
)
def test_each_fault_is_waited_for_as_long_as_the_service_asks(server, store, fault, least, most):
    clock = Hours(NOW)
    server.fail(fault)
    gather(Listed(GitHub(client(clock), server.url), REPO), store)
    assert len(list(store.iterate_reports())) == 250
    assert len(clock.slept) == 1 and least <= clock.slept[0] <= most


def test_waits_grow_with_jitter_and_end_in_giving_up(server):
    clock = Hours(NOW)
    server.fail(*[Fault(502) for _ in range(6)])
    with pytest.raises(CorpusError, match=r"127.0.0.1/x answered with status 502, 6 times in a row; what was gathered"):
        client(clock).get(f"{server.url}/x")
    assert len(clock.slept) == 5
    assert all(2**n / 2 <= slept <= 2**n for n, slept in enumerate(clock.slept))


def test_secondary_limits_double_the_wait(server):
    clock = Hours(NOW)
    server.fail(Fault(403, {}, SECONDARY), Fault(403, {}, SECONDARY), Fault(403, {}, SECONDARY))
    client(clock).get(f"{server.url}/rate_limit")
    assert [60 * 2**n <= slept <= 75 * 2**n for n, slept in enumerate(clock.slept)] == [True] * 3


def test_a_quota_that_is_used_up_is_not_run_into(server):
    """The answer that says that nothing remains is good; the next request is not to be refused."""
    clock = Hours(NOW)
    polite = client(clock)
    server.fail(Fault(headers=limits(0, NOW + 40)))
    polite.get(f"{server.url}/rate_limit", lane="core")
    polite.get(f"{server.url}/rate_limit", lane="search")
    assert clock.slept == []
    polite.get(f"{server.url}/rate_limit", lane="core")
    assert clock.slept == [41]


def test_it_stops_cleanly_and_says_when_to_go_on(server, store):
    clock = Hours(NOW)
    server.fail(Fault(path="/issues"), Fault(403, limits(0, NOW + 3000), PRIMARY))
    source = Listed(GitHub(client(clock, patience=600), server.url), REPO)
    with pytest.raises(Later) as stopped:
        gather(source, store)
    assert str(stopped.value) == (
        "GitHub: the rate limit is reached, and says to come back at 2023-11-14 23:04 UTC (in 50 min); what was "
        "gathered is kept, so run the same command again then"
    )
    assert stopped.value.until == NOW + 3001
    assert clock.slept == []
    assert len(list(store.iterate_reports())) == 100
    clock.time = stopped.value.until
    gather(source, store)
    assert len(list(store.iterate_reports())) == 250


def test_patience_is_for_all_waits_together(server):
    clock = Hours(NOW)
    server.fail(*[Fault(429, {"Retry-After": "50"}) for _ in range(4)])
    with pytest.raises(Later):
        client(clock, patience=120).get(f"{server.url}/x")
    assert clock.slept == [50, 50]


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (
            Fault(403, limits(41, NOW + 300), FORBIDDEN),
            r"status 403 \(Resource not .*\); give a token that may read it",
        ),
        (Fault(401, {}, b'{"message": "Bad credentials"}'), "status 401 .*: give a valid one, or none"),
        (Fault(404, {}, b'{"message": "Not Found"}'), "status 404 .*; check the name, or give a token"),
        (Fault(410, {}, b'{"message": "Issues are disabled for this repo"}'), "status 410 .Issues are disabled"),
        (Fault(400, {}, b"<html>"), "status 400; check what is asked for"),
    ],
)
def test_a_refusal_is_final(server, store, fault, message):
    clock = Hours(NOW)
    server.fail(fault)
    with pytest.raises(StatusError, match=message):
        gather(Listed(GitHub(client(clock), server.url), REPO), store)
    assert len(server.asked) == 1 and clock.slept == []


def test_a_body_that_drips_is_given_up_and_asked_for_anew(server):
    clock = Hours(NOW)
    server.fail(Fault(body=b"[" + b" " * 200 + b"]", pause=0.02))
    _, found = client(clock, timeout=0.1).get_json(f"{server.url}/rate_limit")
    assert "resources" in found and len(clock.slept) == 1


def test_a_body_that_stalls_is_given_up_and_asked_for_anew(server):
    clock = Hours(NOW)
    server.fail(Fault(body=b"[1, 2]", pause=0.5))
    _, found = client(clock, timeout=0.1).get_json(f"{server.url}/rate_limit")
    assert "resources" in found and len(clock.slept) == 1


def test_a_server_that_is_not_there(server):
    address = server.url
    server.close()
    with pytest.raises(CorpusError, match=r"127.0.0.1/x cannot be reached, 3 times in a row"):
        client(Hours(NOW), tries=3).get(f"{address}/x")


@pytest.mark.parametrize("place", ["/circle", "ftp://example.org/x"])
def test_redirects_that_lead_nowhere(server, place):
    server.fail(*[Fault(302, {"Location": place}) for _ in range(20)])
    with pytest.raises(CorpusError, match="redirects"):
        client(Hours(NOW), tries=2).get(f"{server.url}/circle")


def test_no_redirect_leaves_the_host_that_was_asked(server):
    other = Services()
    try:
        for place in (f"{other.url}/rate_limit", "http://169.254.169.254/latest/", "//evil.example.org/x",
                      server.url.replace("http:", "https:"), server.url.replace("//", "//user:word@")):  # fmt: skip
            server.fail(Fault(301, {"Location": place}))
            with pytest.raises(CorpusError, match=r"redirects to https?://[^/]+, which is not asked"):
                client(Hours(NOW)).get(f"{server.url}/x", headers={"Authorization": "Bearer t"})
        assert other.asked == []
    finally:
        other.close()
    server.asked.clear()
    server.fail(Fault(301, {"Location": "/rate_limit"}))
    client(Hours(NOW)).get(f"{server.url}/x", headers={"Authorization": "Bearer t"})
    assert [asked.headers.get("authorization") for asked in server.asked] == ["Bearer t"] * 2


@pytest.mark.parametrize(
    ("url", "place", "onward"),
    [
        ("http://mirror.example.org/x", "https://mirror.example.org/x", "https://mirror.example.org/x"),
        ("https://mirror.example.org/x", "http://mirror.example.org/x", None),
        ("http://mirror.example.org:8080/x", "https://mirror.example.org/x", None),
        ("https://mirror.example.org/x", "https://mirror.example.org.evil.example/x", None),
        ("https://mirror.example.org/x", "https://mirror.example.org:99999/x", None),
        ("https://mirror.example.org/x", "https://[::1/x", None),
        ("https://mirror.example.org/x", "file:///etc/passwd", None),
    ],
)
def test_where_a_redirect_may_lead(url, place, onward):
    from rosimpact.corpus.polite import _Fault, _resolve_redirect

    if onward:
        assert _resolve_redirect("Askbot", url, place) == onward
    else:
        with pytest.raises((CorpusError, _Fault)):
            _resolve_redirect("Askbot", url, place)


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (Fault(body=gzip.compress(bytes(80 << 20)), headers={"Content-Encoding": "gzip"}), "sends more than 64 MB"),
        (Fault(body=gzip.compress(gzip.compress(bytes(1 << 20))), headers={"Content-Encoding": "gzip, gzip"}),
         "packed its answer in a way that was not asked for"),
        (Fault(body=b"x", headers={"Content-Encoding": "br"}), "packed its answer in a way"),
        (Fault(body=b"[" * 100_000 + b"]" * 100_000), "that is no JSON"),
        (Fault(body=b"[" + b"9" * 5_000 + b"]"), "that is no JSON"),
        (Fault(429, {"Retry-After": "9" * 15}), "says to come back at"),
        (Fault(429, {"Retry-After": "\u00b2"}), "is over its rate limit|come back"),
        (Fault(403, limits(0, 10**14), PRIMARY), "says to come back at"),
    ],
)  # fmt: skip
def test_a_hostile_answer_is_one_error(server, fault, message):
    server.fail(fault)
    with pytest.raises(CorpusError, match=message):
        client(Hours(NOW), tries=1, patience=1).get_json(f"{server.url}/rate_limit")


def test_halves_of_characters_do_not_stop_a_gathering(server, store):
    server.issues[REPO] = [issue(REPO, 1, title="half \ud83d of one", body="\udcff")]
    gather(Listed(GitHub(client(Hours(NOW)), server.url), REPO), store)
    assert [(report.title, report.body) for report in store.iterate_reports()] == [("half \ufffd of one", "\ufffd")]


def test_a_token_that_a_server_repeats_is_not_shown(server):
    server.fail(Fault(401, {}, b'{"message": "bad token ghp_repeated"}'))
    with pytest.raises(StatusError) as refused:
        client(Hours(NOW), secrets=["ghp_repeated"]).get(f"{server.url}/x")
    assert "ghp_repeated" not in str(refused.value) and "***" in str(refused.value)


@pytest.mark.parametrize(
    "api", ["https://me:s3cret@ghe.example.org", "https://x:99999", "https://[::1", "file:///x", "https://h/?key=s3cret",
            "https:///x", "https://a\\@b/"],
)  # fmt: skip
def test_an_address_of_a_service_is_plain(api):
    with pytest.raises(CorpusError, match="--api") as refused:
        GitHub(client(Hours(NOW)), api)
    assert "s3cret" not in str(refused.value)


def test_a_list_that_leads_to_another_server_is_not_followed(server, store):
    server.issues[REPO] = [issue(REPO, n, day="2024-01-01T00:00:00Z") for n in range(1, 250)]
    server.fail(Fault(), Fault(headers={"Link": '<https://evil.example.org/x>; rel="next"'}))
    with pytest.raises(CorpusError, match=r"leads to evil.example.org for its next page"):
        gather(Listed(GitHub(client(Hours(NOW)), server.url, "t"), REPO), store)


def test_faults_of_a_search_are_met_in_the_same_way(server, store):
    """PyGithub itself would sleep on a 403, and would give up on a 429."""
    clock = Hours(NOW)
    html = Fault(body=b"<html>", headers={"Content-Type": "text/html"})
    server.fail(Fault(429, {"Retry-After": "30"}), Fault(502), html, Fault(403, {}, SECONDARY))
    gather(Searched(GitHub(client(clock), server.url, "t"), f"repo:{REPO}"), store)
    assert len(list(store.iterate_reports())) == 250
    assert len(clock.slept) == 4 and clock.slept[0] == 30
    assert {asked.headers["authorization"] for asked in server.asked} == {"token t"} or {
        asked.headers["authorization"] for asked in server.asked
    } == {"Bearer t"}


# -- Stack Exchange ----------------------------------------------------------------------------------------------------


def exchange(server: Services, clock: Hours, **more) -> StackExchange:
    return StackExchange(Client("Stack Exchange", clock=clock, timeout=2, **more), f"{server.url}/2.3", "k3y")


def test_backoff_is_obeyed_though_the_answer_is_good(server, store):
    clock = Hours(NOW)
    server.questions = [question(n) for n in range(1, 151)]
    server.backoff = 11
    gather(TaggedQuestions(exchange(server, clock), "ros2"), store)
    assert clock.slept == [11]


def test_the_quota_of_the_day_ends_the_day(server, store):
    clock = Hours(NOW)  # 22:13:20 UTC
    server.questions = [question(n) for n in range(1, 351)]
    server.quota = 2
    with pytest.raises(Later, match=r"the quota of the day is used up, .* at 2023-11-15 00:00 UTC \(in 1.8 h\)"):
        gather(TaggedQuestions(exchange(server, clock, patience=60), "ros2"), store)
    assert len(list(store.iterate_reports())) > 100
    server.quota = 100
    gather(TaggedQuestions(exchange(server, clock), "ros2"), store)
    assert len(list(store.iterate_reports())) == 350


def test_a_throttle_that_arrives_as_status_400_tells_its_seconds(server, store):
    clock = Hours(NOW)
    server.questions = [question(1)]
    server.quota = 0
    with pytest.raises(Later, match=r"too many requests came from here, .* \(in 11.5 h\)"):
        gather(TaggedQuestions(exchange(server, clock), "ros2"), store)


def test_a_question_that_stack_exchange_refuses(server, store):
    wrong = b'{"error_id": 400, "error_name": "bad_parameter", "error_message": "site"}'
    server.fail(Fault(400, {}, wrong))
    with pytest.raises(StatusError, match=r"refused \(bad_parameter: site\)"):
        gather(TaggedQuestions(exchange(server, Hours(NOW)), "ros2"), store)


# -- secrets -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("api", "environment", "token"),
    [
        ("https://api.github.com", {"GITHUB_TOKEN": "a", "GH_TOKEN": "b"}, "a"),
        ("https://api.github.com", {"GH_TOKEN": "b\n"}, "b"),
        ("https://api.github.com", {"GH_ENTERPRISE_TOKEN": "c"}, ""),
        ("https://ghe.example.org/api/v3", {"GITHUB_TOKEN": "a"}, ""),  # another host gets no token of github.com
        ("https://ghe.example.org/api/v3", {"GITHUB_TOKEN": "a", "GH_ENTERPRISE_TOKEN": "c"}, "c"),
        ("https://ghe.example.org/api/v3",
         {"GITHUB_TOKEN": "a", "GITHUB_API_URL": "https://ghe.example.org/api/v3"}, "a"),
        ("http://api.github.com", {"GITHUB_TOKEN": "a"}, ""),  # not in the clear
        ("http://127.0.0.1:9", {"GH_ENTERPRISE_TOKEN": "c"}, "c"),
    ],
)  # fmt: skip
def test_a_token_goes_only_to_the_service_it_is_for(monkeypatch, api, environment, token):
    monkeypatch.setattr("rosimpact.corpus.tokens._read_keyring", lambda user: "")
    assert find_github_token(api, environment) == token


def test_a_key_goes_only_to_stack_exchange(monkeypatch):
    monkeypatch.setattr("rosimpact.corpus.tokens._read_keyring", lambda user: "")
    key = {"STACK_EXCHANGE_KEY": "k"}
    assert find_stack_exchange_key("https://api.stackexchange.com/2.3", key) == "k"
    assert find_stack_exchange_key("https://mirror.example.org/2.3", key) == ""


def test_the_keyring_is_asked_where_the_environment_has_nothing(monkeypatch):
    keyring = pytest.importorskip("keyring")
    monkeypatch.setattr(keyring, "get_password", lambda service, user: f"{service}/{user}")
    assert find_github_token("https://api.github.com", {}) == "rosimpact/github@api.github.com"


def test_a_keyring_that_cannot_be_opened_means_no_token(monkeypatch):
    keyring = pytest.importorskip("keyring")

    def locked(service: str, user: str) -> str:
        raise RuntimeError("locked")

    monkeypatch.setattr(keyring, "get_password", locked)
    assert find_github_token("https://api.github.com", {}) == ""


def test_secrets_are_in_no_message_no_log_and_no_store(server, tmp_path, monkeypatch):
    """Whatever goes wrong, and though the logs of all libraries are on."""
    monkeypatch.setenv("NETRC", str(tmp_path / "netrc"))
    (tmp_path / "netrc").write_text("machine 127.0.0.1 login me password n3tr3\n")
    token, key = "ghp_s3cr3t", "k3y_s3cr3t"
    log = io.StringIO()
    handler = logging.StreamHandler(log)
    logging.getLogger().addHandler(handler)
    level = logging.getLogger().level
    logging.getLogger().setLevel(logging.DEBUG)
    # Dask switches off the loggers that it finds when it is imported.
    monkeypatch.setattr(logging.getLogger("urllib3.connectionpool"), "disabled", False)
    server.questions = [question(n) for n in range(1, 120)]
    said: list[str] = []
    try:
        with CorpusStore(tmp_path / "corpus.sqlite") as store:
            for fault in (
                Fault(),
                Fault(401),
                Fault(404),
                Fault(403, {}, FORBIDDEN),
                Fault(422),
                Fault(body=b"<html>"),
            ):
                for tries in (1, 2):
                    more = {"clock": Hours(NOW), "timeout": 2, "tries": tries, "tell": said.append}
                    hub = GitHub(Client("GitHub", secrets=[token], **more), server.url, token)
                    site = StackExchange(Client("Stack Exchange", secrets=[key], **more), f"{server.url}/2.3", key)
                    for source in (Listed(hub, REPO), Searched(hub, "x"), TaggedQuestions(site, "ros2")):
                        server.faults[:] = [fault]
                        try:
                            gather(source, store)
                        except CorpusError as error:
                            said += [str(error), repr(error), repr(error.__context__), repr(error.__cause__)]
    finally:
        logging.getLogger().setLevel(level)
        logging.getLogger().removeHandler(handler)
    assert any(asked.headers.get("authorization", "").endswith(token) for asked in server.asked)
    assert any(asked.query.get("key") == key for asked in server.asked)
    assert "/2.3/questions" in log.getvalue(), "the libraries must have logged for this test to mean something"
    everything = log.getvalue() + "\n".join(said)
    assert token not in everything and key not in everything
    for file in tmp_path.glob("corpus*"):
        assert token.encode() not in file.read_bytes() and key.encode() not in file.read_bytes()
    assert not any("n3tr3" in str(asked.headers) or "Basic" in str(asked.headers) for asked in server.asked)
