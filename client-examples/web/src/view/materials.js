import { Color, DoubleSide, ShaderMaterial, Vector2 } from 'three';

const POINT_VERTEX = `
attribute vec3 tint;
uniform float size;
uniform float pixelRatio;
uniform float ambient;
varying vec3 v_tint;
void main() {
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    // Without a normal (it is zero) there is no shading. Its sign means nothing.
    vec3 towards = normalize(seen.xyz + vec3(-0.45, -0.6, 0.0) * length(seen.xyz));
    float facing = abs(dot(normalize(normalMatrix * normal + 1e-9), towards));
    v_tint = tint * (dot(normal, normal) > 0.0 ? mix(facing, 1.0, ambient) : 1.0);
    gl_Position = projectionMatrix * seen;
    gl_PointSize = clamp(size / -seen.z, 1.5 * pixelRatio, 24.0 * pixelRatio);
}`;

const POINT_FRAGMENT = `
varying vec3 v_tint;
void main() {
    vec2 offset = gl_PointCoord - 0.5;
    if (dot(offset, offset) > 0.25) discard;
    gl_FragColor = vec4(v_tint, 1.0);
}`;

const MESH_VERTEX = `
attribute vec3 tint;
varying vec3 v_tint;
varying vec3 v_seen;
void main() {
    v_tint = tint;
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    v_seen = seen.xyz;
    gl_Position = projectionMatrix * seen;
}`;

const MESH_FRAGMENT = `
uniform float ambient;
varying vec3 v_tint;
varying vec3 v_seen;
void main() {
    vec3 normal = normalize(cross(dFdx(v_seen), dFdy(v_seen)));
    float facing = abs(dot(normal, normalize(v_seen + vec3(-0.3, -0.4, 0.0) * length(v_seen))));
    gl_FragColor = vec4(v_tint * mix(facing, 1.0, ambient), 1.0);
}`;

/** Round points of one size in space. */
export function point_material() {
    return new ShaderMaterial({
        vertexShader: POINT_VERTEX,
        fragmentShader: POINT_FRAGMENT,
        uniforms: { size: { value: 1 }, pixelRatio: { value: 1 }, ambient: { value: 0.4 } },
    });
}

/** Flat triangles in the light of the viewer. */
export function mesh_material() {
    return new ShaderMaterial({
        vertexShader: MESH_VERTEX,
        fragmentShader: MESH_FRAGMENT,
        uniforms: { ambient: { value: 0.4 } },
        side: DoubleSide,
    });
}

const SHADE_FRAGMENT = `
uniform sampler2D picture;
uniform sampler2D depth;
uniform vec2 texel;
uniform float near;
uniform float far;
uniform float strength;
uniform vec3 background;
varying vec2 v_uv;
float log_depth(vec2 at) {
    float d = texture2D(depth, at).x;
    return log2(near * far / (far - d * (far - near)));
}
void main() {
    if (texture2D(depth, v_uv).x >= 1.0) {
        gl_FragColor = vec4(background, 1.0);
        return;
    }
    float here = log_depth(v_uv);
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        float angle = 0.785398 * float(i);
        vec2 at = v_uv + texel * vec2(cos(angle), sin(angle));
        sum += max(0.0, here - log_depth(at));
    }
    float light = exp(-strength * sum / 8.0);
    gl_FragColor = vec4(texture2D(picture, v_uv).rgb * (0.18 + 0.82 * light), 1.0);
}`;

/**
 * Eye-dome lighting (Boucheny 2009): darkens what lies behind its neighbours in the picture, which
 * shows the form of points that have no normals.
 */
export function shade_material() {
    return new ShaderMaterial({
        vertexShader: 'varying vec2 v_uv; void main() { v_uv = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
        fragmentShader: SHADE_FRAGMENT,
        uniforms: {
            picture: { value: null }, depth: { value: null }, texel: { value: new Vector2() },
            near: { value: 1 }, far: { value: 2 }, strength: { value: 55 },
            background: { value: new Color() },
        },
        depthTest: false,
        depthWrite: false,
    });
}
