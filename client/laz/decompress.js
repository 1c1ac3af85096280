// Reads one line of JSON, { path, format, length, chunks: [[byte, length, points], …] }, and writes the records of the chunks.
import { createLazPerf } from "laz-perf";
import { openSync, readFileSync, readSync, writeSync } from "node:fs";

const AT_ONCE = 16384; // records
const BEYOND = 4096; // zeros behind a chunk: laz-perf reads a damaged one beyond its end

function write(data) {
    for (let at = 0; at < data.length; ) at += writeSync(1, data, at);
}

function decompress(lazPerf, file, { format, length }, records, [at, size, points]) {
    const input = lazPerf._malloc(size + BEYOND);
    if (input === 0) throw new Error("there is too little memory for it");
    lazPerf.HEAPU8.fill(0, input + size, input + size + BEYOND);
    for (let read = 0; read < size; ) {
        const more = readSync(file, lazPerf.HEAPU8, input + read, size - read, at + read);
        if (more === 0) throw new Error("the file ends within it");
        read += more;
    }
    const decoder = new lazPerf.ChunkDecoder();
    decoder.open(format, length, input);
    for (let done = 0; done < points; ) {
        const count = Math.min(AT_ONCE, points - done);
        for (let n = 0; n < count; n++) decoder.getPoint(records + n * length);
        write(lazPerf.HEAPU8.subarray(records, records + count * length));
        done += count;
    }
    decoder.delete();
    lazPerf._free(input);
}

const asked = JSON.parse(readFileSync(0, "utf8"));
const file = openSync(asked.path, "r");
const lazPerf = await createLazPerf({ print: () => {}, printErr: () => {} });
const records = lazPerf._malloc(AT_ONCE * asked.length);
for (const chunk of asked.chunks) {
    try {
        decompress(lazPerf, file, asked, records, chunk);
    } catch (error) {
        if (error.code === "EPIPE") process.exit(1); // nobody reads on
        writeSync(2, `byte ${chunk[0]}: a chunk of points cannot be decompressed: ${String(error).split("\n")[0].slice(0, 200)}`);
        process.exit(2);
    }
}
