import { defineConfig } from 'vite';

/** three names decoders that this page never loads: for glTF, and without WebAssembly. */
const only_the_decoder_in_use = {
    name: 'only-the-decoder-in-use',
    generateBundle(_, bundle) {
        for (const [name, file] of Object.entries(bundle)) {
            const origin = file.originalFileNames?.[0] ?? '';
            if (/libs\/draco\/(gltf\/|draco_decoder\.js)/.test(origin)) delete bundle[name];
        }
    },
};

export default defineConfig({
    base: './',
    build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
    worker: { format: 'es', plugins: () => [only_the_decoder_in_use] },
    plugins: [only_the_decoder_in_use],
    server: { proxy: { '/v1': 'http://127.0.0.1:8080' } },
});
