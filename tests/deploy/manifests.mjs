// Checks Kubernetes manifests as far as that goes without a cluster: each object against the schema of
// its kind (kubernetes-models), its fields against the declared types (which no schema does: there, a
// misspelt field is an unknown one and passes), and names against what they refer to.
import { readFileSync } from "node:fs";
import ts from "typescript";
import { parseAllDocuments } from "yaml";

// "apps/v1 Deployment" -> "kubernetes-models/apps/v1/Deployment"
function moduleOf(object) {
    return `kubernetes-models/${object.apiVersion}/${object.kind}`;
}

export function read(file) {
    return parseAllDocuments(readFileSync(file, "utf8"), { strict: true }).map((document) => {
        if (document.errors.length > 0) throw document.errors[0];
        return document.toJS();
    });
}

async function schemaFaults(object) {
    const { [object.kind]: Kind } = await import(moduleOf(object));
    try {
        new Kind(object).validate();
        return [];
    } catch (error) {
        return [`${object.kind}: ${error.message}`];
    }
}

// The objects as literals of a TypeScript file: its compiler finds unknown fields and wrong types.
function typeFaults(objects) {
    const lines = objects.flatMap((object, i) => [
        `import { I${object.kind} as Kind${i} } from "${moduleOf(object)}";`,
        `export const object${i}: Kind${i} = ${JSON.stringify(object, null, 1)};`,
    ]);
    const options = {
        noEmit: true, strict: true, skipLibCheck: true, types: [],
        module: ts.ModuleKind.NodeNext, moduleResolution: ts.ModuleResolutionKind.NodeNext,
    };
    const host = ts.createCompilerHost(options);
    const name = new URL("objects.ts", import.meta.url).pathname;
    const file = ts.createSourceFile(name, lines.join("\n"), ts.ScriptTarget.ES2022);
    const { getSourceFile, fileExists } = host;
    host.getSourceFile = (path, ...rest) => (path === name ? file : getSourceFile(path, ...rest));
    host.fileExists = (path) => path === name || fileExists(path);
    return ts.getPreEmitDiagnostics(ts.createProgram([name], options, host))
        .map((found) => ts.flattenDiagnosticMessageText(found.messageText, " "));
}

function matches(selector, labels) {
    return Object.entries(selector).every(([name, value]) => labels[name] === value);
}

// Names that lead nowhere.
function nameFaults(objects) {
    const faults = [];
    const of = (kind) => objects.filter((object) => object.kind === kind);
    const need = (found, text) => found || faults.push(text);
    for (const { metadata, spec: { selector, template } } of of("Deployment")) {
        const pod = template.spec;
        need(matches(selector.matchLabels, template.metadata.labels),
             `${metadata.name}: its selector does not match its own pods`);
        const volumes = pod.volumes.map((volume) => volume.name);
        for (const container of pod.containers) {
            const ports = container.ports.map((port) => port.name);
            for (const probe of ["startupProbe", "readinessProbe", "livenessProbe"])
                need(ports.includes(container[probe].httpGet.port), `${probe}: no such port`);
            for (const mount of container.volumeMounts)
                need(volumes.includes(mount.name), `${mount.mountPath}: no such volume`);
        }
        for (const { persistentVolumeClaim: claim } of pod.volumes.filter((v) => v.persistentVolumeClaim))
            need(of("PersistentVolumeClaim").some((o) => o.metadata.name === claim.claimName),
                 `${claim.claimName}: no such claim`);
    }
    const pods = of("Deployment").map((deployment) => deployment.spec.template);
    for (const { metadata, spec } of of("Service")) {
        const served = pods.filter((pod) => matches(spec.selector, pod.metadata.labels));
        const ports = served.flatMap((pod) => pod.spec.containers.flatMap((c) => c.ports));
        for (const { targetPort } of spec.ports)
            need(ports.some((port) => port.name === targetPort),
                 `service ${metadata.name}: no pod has the port ${targetPort}`);
    }
    for (const { spec } of of("Ingress"))
        for (const path of spec.rules.flatMap((rule) => rule.http.paths)) {
            const { name, port } = path.backend.service;
            const service = of("Service").find((object) => object.metadata.name === name);
            need(service?.spec.ports.some((offered) => offered.name === port.name),
                 `ingress: the service ${name} has no port ${port.name}`);
        }
    return faults;
}

export async function faultsOf(objects) {
    const schema = (await Promise.all(objects.map(schemaFaults))).flat();
    return [...schema, ...typeFaults(objects), ...nameFaults(objects)];
}
