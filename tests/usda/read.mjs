// read.mjs SCENE.tss SCENE.usda ...: reads each .usda with two readers that are not ours, three's USDAParser and
// tinyusdz, and checks that each prim and each property of the .tss (as JSON) is there by its USD name.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { USDAParser } from 'three/examples/jsm/loaders/usd/USDAParser.js';

let wrong = 0;
function check(holds, what) {
  if (holds) return;
  console.error('wrong: ' + what);
  ++wrong;
}

// tinyusdz is built for browsers, and takes Node for one when it looks like this.
globalThis.window = globalThis;
Object.defineProperty(process, 'type', { value: 'renderer' });
const tinyusdz = path.dirname(createRequire(import.meta.url).resolve('tinyusdz/package.json'));
const { default: tinyUsdz } = await import(path.join(tinyusdz, 'tinyusdz.js'));
const module = await tinyUsdz({ wasmBinary: fs.readFileSync(path.join(tinyusdz, 'tinyusdz.wasm')) });

let meshes = 0;
let properties = 0;

const key = (property, name) =>
  (property.custom ? 'custom ' : '') +
  (property.variability === 'uniform' ? 'uniform ' : '') +
  ('targetPaths' in property ? 'rel ' : property.typeName + ' ') + name;

// Every prim of the JSON against what three's parser has under its parent.
function compare(prims, parsed, above) {
  for (const prim of prims ?? []) {
    const where = above + '/' + prim.name;
    const type = prim.typeName ? ' ' + prim.typeName : '';
    const found = parsed[`${prim.specifier ?? 'def'}${type} "${prim.name}"`];
    check(found !== undefined, where + ' is missing');
    if (found === undefined) continue;
    if (prim.typeName === 'Mesh') ++meshes;
    for (const [name, property] of Object.entries(prim.properties ?? {})) {
      ++properties;
      if ('default' in property || 'targetPaths' in property) check(key(property, name) in found, `${where}.${name}`);
      if ('default' in property && typeof property.default === 'number')
        check(Math.abs(Number(found[key(property, name)]) - property.default) <= 1e-6 * Math.abs(property.default),
          `${where}.${name} = ${found[key(property, name)]}`);
      // It reads no more than the name of time samples; tinyusdz reads them.
      if ('timeSamples' in property) check(key(property, name) + '.timeSamples' in found, `${where}.${name}.timeSamples`);
    }
    compare(prim.primChildren, found, where);
  }
}

const files = process.argv.slice(2);
for (let i = 0; i + 1 < files.length; i += 2) {
  const scene = JSON.parse(fs.readFileSync(files[i], 'utf8'));
  const usda = fs.readFileSync(files[i + 1]);
  meshes = properties = 0;
  compare(scene.primChildren, new USDAParser().parseText(usda.toString('utf8')), '');
  const reader = new module.TinyUSDZLoaderNative();
  const read = reader.loadFromBinary(new Uint8Array(usda), files[i + 1]);
  check(read, `${files[i + 1]}: tinyusdz: ${reader.error()}`);
  check(reader.numMeshes() === meshes, `${files[i + 1]}: tinyusdz reads ${reader.numMeshes()} meshes of ${meshes}`);
  console.log(`${path.basename(files[i + 1])}: ${meshes} meshes, ${properties} properties`);
}
process.exit(wrong === 0 ? 0 : 1);
