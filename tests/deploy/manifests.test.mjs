// The manifests that are shipped are sound, and the check finds what is not.
import assert from "node:assert";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { faultsOf, read } from "./manifests.mjs";

const folder = process.env.LPF_MANIFESTS;
const shipped = () => readdirSync(folder).filter((name) => name.endsWith(".yaml"))
    .flatMap((name) => read(join(folder, name)));
const find = (objects, kind) => objects.find((object) => object.kind === kind);
const container = (objects) => find(objects, "Deployment").spec.template.spec.containers[0];

test("what is shipped has no fault", async () => {
    const objects = shipped();
    assert.deepEqual(objects.map((object) => object.kind).sort(),
                     ["Deployment", "Ingress", "NetworkPolicy", "PersistentVolumeClaim", "Service"]);
    assert.deepEqual(await faultsOf(objects), []);
});

test("the server runs with few rights, and one at a time", () => {
    const { spec } = find(shipped(), "Deployment");
    assert.equal(spec.replicas, 1);
    assert.equal(spec.strategy.type, "Recreate");
    const pod = spec.template.spec;
    assert.equal(pod.securityContext.runAsUser, 65532);
    assert.ok(pod.securityContext.runAsNonRoot);
    const { securityContext } = pod.containers[0];
    assert.ok(securityContext.readOnlyRootFilesystem && !securityContext.allowPrivilegeEscalation);
    assert.deepEqual(securityContext.capabilities, { drop: ["ALL"] });
});

const breaches = {
    "a misspelt field": (objects) => { container(objects).readynessProbe = {}; },
    "a wrong type": (objects) => { find(objects, "Deployment").spec.replicas = "one"; },
    "a missing field": (objects) => { delete find(objects, "Deployment").spec.selector; },
    "a port that is not there": (objects) => {
        container(objects).livenessProbe.httpGet.port = "adnim";
    },
    "a volume that is not there": (objects) => { container(objects).volumeMounts[0].name = "dat"; },
    "a claim that is not there": (objects) => {
        find(objects, "PersistentVolumeClaim").metadata.name = "other";
    },
    "a service that finds no port": (objects) => {
        find(objects, "Service").spec.ports[0].targetPort = "htp";
    },
};
for (const [name, breach] of Object.entries(breaches)) {
    test(`${name} is found`, async () => {
        const objects = shipped();
        breach(objects);
        const faults = await faultsOf(objects).catch((error) => [error.message]);
        assert.notDeepEqual(faults, []);
    });
}
