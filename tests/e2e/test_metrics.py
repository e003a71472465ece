"""The figures of the running server, read by the parser of Prometheus' own client library."""

import requests
from prometheus_client.parser import text_string_to_metric_families

from shapes import noisy_sphere


def families(server):
    answer = requests.get(server.admin_url + "/metrics", timeout=10)
    assert answer.headers["Content-Type"].startswith("text/plain; version=0.0.4")
    read = list(text_string_to_metric_families(answer.text))
    assert len({family.name for family in read}) == len(read), "a family comes twice"
    return {family.name: family for family in read}


def check_histogram(family):
    """Buckets grow with their bounds, end with +Inf, and the last is the count."""
    series, counts = {}, {}
    for sample in family.samples:
        labels = {k: v for k, v in sample.labels.items() if k != "le"}
        key = tuple(sorted(labels.items()))
        if sample.name.endswith("_bucket"):
            series.setdefault(key, []).append((float(sample.labels["le"]), sample.value))
        elif sample.name.endswith("_count"):
            counts[key] = sample.value
    assert set(series) == set(counts)
    for key, buckets in series.items():
        assert buckets == sorted(buckets)
        assert [value for _, value in buckets] == sorted(value for _, value in buckets)
        assert buckets[-1] == (float("inf"), counts[key])


def test_the_text_parses_and_tells_what_happened(start):
    server = start()
    done = requests.post(server.url + "/v1/processes/denoise/execution", data=noisy_sphere(),
                         headers={"Prefer": "wait=60"}, timeout=90)
    assert done.status_code == 200
    requests.get(server.url + "/v1/jobs/nothing", timeout=10)
    read = families(server)
    for family in read.values():
        assert family.name.startswith("lpf_") and family.documentation, family.name
        seen = [(s.name, tuple(sorted(s.labels.items()))) for s in family.samples]
        assert len(set(seen)) == len(seen), family.name
        if family.type == "histogram":
            check_histogram(family)

    def value(name, **labels):
        family = read[name.removesuffix("_total").removesuffix("_count")]
        found = [s.value for s in family.samples if s.name == name and s.labels == labels]
        assert len(found) == 1, (name, labels)
        return found[0]

    assert value("lpf_job_seconds_count", process="denoise", status="successful") == 1
    assert value("lpf_problems_total", code="job-not-found") == 1
    assert value("lpf_http_requests_total", method="POST", status="200",
                 route="/v1/processes/{id}/execution") == 1
    assert value("lpf_http_received_bytes_total") == len(noisy_sphere())
    assert value("lpf_queue_depth") == 0
    assert value("lpf_event_streams") == 0
    assert value("lpf_lease_losses_total") == 0
    assert value("lpf_queue_wait_seconds_count") == 1
