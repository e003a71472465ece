"""A client that believes nothing: checks every answer against the served OpenAPI document."""

import re

import jsonschema
import requests


class Contract:
    """The OpenAPI document of a server, as a judge of its answers."""

    def __init__(self, document):
        self.document = document
        self.resolver = jsonschema.RefResolver("", document)
        self.paths = []
        for template, operations in document["paths"].items():
            pattern = re.sub(r"\{[^}]+\}", "[^/]+", template)
            self.paths.append(("{" in template, re.compile(pattern + "/?$"), operations))
        self.paths.sort(key=lambda entry: entry[0])  # paths without placeholders first

    def operation(self, method, path):
        for _, pattern, operations in self.paths:
            if pattern.match(path) and method.lower() in operations:
                return operations[method.lower()]
        raise AssertionError(f"{method} {path} is not in the OpenAPI document")

    def resolve(self, node):
        while "$ref" in node:
            node = self.resolver.resolve(node["$ref"])[1]
        return node

    def check(self, method, path, response):
        operation = self.operation(method, path)
        where = f"{method} {path} -> {response.status_code}"
        assert response.headers.get("X-Request-Id"), f"{where} has no id"
        answers = operation["responses"]
        assert str(response.status_code) in answers, f"{where} is not documented: {response.text}"
        answer = self.resolve(answers[str(response.status_code)])
        content = answer.get("content", {})
        if method == "HEAD" or not content:
            assert not response.content, f"{where} has a body that is not documented"
            return
        media_type = response.headers["Content-Type"].split(";")[0]
        documented = {name.split(";")[0]: value for name, value in content.items()}
        assert media_type in documented, f"{where} has the type {media_type}"
        if media_type.endswith("json"):
            schema = documented[media_type].get("schema", {})
            validator = jsonschema.Draft202012Validator(schema, resolver=self.resolver)
            errors = sorted(validator.iter_errors(response.json()), key=str)
            assert not errors, f"{where}: {errors[0].message} at {list(errors[0].absolute_path)}"
        if response.status_code >= 400 and media_type == "application/problem+json":
            said = response.json().get("requestId", response.headers["X-Request-Id"])
            assert said == response.headers["X-Request-Id"], f"{where} has two ids"


class Client:
    """Sends requests to one server and checks every answer."""

    def __init__(self, url, headers=None):
        """`headers` go with every request, such as a key."""
        self.url = url
        self.headers = headers or {}
        document = requests.get(url + "/v1/openapi.json", headers=self.headers, timeout=30)
        assert document.status_code == 200
        self.contract = Contract(document.json())

    def raw(self, method, path, **options):
        """A request that the document does not speak of."""
        headers = {**self.headers, **options.pop("headers", {})}
        return requests.request(method, self.url + path, timeout=120, headers=headers, **options)

    def request(self, method, path, **options):
        response = self.raw(method, path, **options)
        self.contract.check(method, path.split("?")[0], response)
        return response

    def get(self, path, **options):
        return self.request("GET", path, **options)

    def post(self, path, data=None, **options):
        return self.request("POST", path, data=data, **options)

    def delete(self, path):
        return self.request("DELETE", path)

    def execute(self, process, data, query="", wait=None, **options):
        headers = dict(options.pop("headers", {}))
        if wait is not None:
            headers["Prefer"] = f"wait={wait}"
        return self.post(f"/v1/processes/{process}/execution{query}", data=data,
                         headers=headers, **options)

    def finish(self, job):
        """Follows a job to its end."""
        path = "/v1/jobs/" + job["jobID"]
        while job["status"] in ("accepted", "running"):
            job = self.get(path, headers={"Prefer": "wait=10"}).json()
        return job

    def run(self, process, data, query=""):
        """Runs a job that must succeed, and returns its path."""
        created = self.execute(process, data, query)
        assert created.status_code == 201, created.text
        job = self.finish(created.json())
        assert job["status"] == "successful", job
        return "/v1/jobs/" + job["jobID"]
