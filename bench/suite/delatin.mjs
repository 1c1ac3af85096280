// Thins a raster of heights with delatin, in memory: delatin.mjs HEIGHTS WIDTH HEIGHT MAX_ERROR, in a folder with node_modules.
// HEIGHTS is a file of 32-bit floats. Prints a line of JSON: seconds of the wall and of the processor, and vertices.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';

const [file, width, height, error] = process.argv.slice(2);
const path = createRequire(`${process.cwd()}/package.json`).resolve('delatin');
const {default: Delatin} = await import(pathToFileURL(path));
const bytes = readFileSync(file);
const heights = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
const used = process.cpuUsage(), began = process.hrtime.bigint();
const tin = new Delatin(heights, Number(width), Number(height));
tin.run(Number(error));
const wall = Number(process.hrtime.bigint() - began) / 1e9, {user, system} = process.cpuUsage(used);
console.log(JSON.stringify({wall, cpu: (user + system) / 1e6, vertices: tin.coords.length / 2}));
