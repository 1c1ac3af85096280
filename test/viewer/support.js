// What the tests of the viewer share: meshes in the database that the environment names, and servers that show them.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import net from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { start } from "../../viewer/server.js";

export const packages = createRequire(new URL("../../viewer/package.json", import.meta.url));
const pg = packages("pg");

// A file of tests that hangs fails: something keeps it running, and nothing comes of it any more.
const mostOfFile = 900_000;
setTimeout(() => {
    console.error(`not ended within ${mostOfFile / 1000} seconds: ${process.getActiveResourcesInfo().join(", ")}`);
    process.exit(1);
}, mostOfFile).unref();

/** What psql says, without headings. It stops this process while it runs, so it must end, whatever else holds a lock. */
export const psql = (text, most = 120_000) =>
    execFileSync("psql", ["-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-c", text], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"], timeout: most }).trim();

export function makeMeshes() {
    psql("SET client_min_messages = warning; DROP TABLE IF EXISTS terrain, globe, rock, shire CASCADE");
    psql(`SELECT abacus_triangulate('terrain', 'SELECT 1000 * i + j AS id, 400000 + 30 * i + (i * 7919 + j * 104729) % 13 AS x,
              5200000 + 30 * j + (i * 31 + j * 17) % 11 AS y, 900 + 300 * sin(i / 9.0) * cos(j / 11.0) + i AS height
              FROM generate_series(0, 59) AS i, generate_series(0, 49) AS j')`);
    psql(`SELECT abacus_triangulate('shire', 'SELECT i * 100 + j AS id, 10 * i + (j % 3) AS x, 10 * j + (i % 3) AS y, i * j AS height FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j');
          SELECT abacus_constrain('shire', 'VALUES (1, 1, 202), (1, 2, 1802), (1, 3, 1818), (1, 4, 218), (1, 5, 202), (2, 1, 606), (2, 2, 1206), (2, 3, 1212), (2, 4, 612), (2, 5, 606)');
          SELECT abacus_region('shire', $$VALUES ('farm', 1), ('farm', 2)$$); SELECT abacus_region('shire', $$VALUES ('O''Hara & "lake"', 2)$$)`);
    psql(`SELECT abacus_triangulate('globe', 'SELECT 1000 * i + j AS id, 7 + i / 50.0 + sin(i * 3 + j) / 300 AS lon, 46 + j / 50.0 + cos(i + 5 * j) / 300 AS lat
              FROM generate_series(0, 29) AS i, generate_series(0, 29) AS j')`);
    psql(`SELECT abacus_triangulate('rock', 'SELECT 10000 * i + 100 * j + k AS id, i + sin(j * k) / 4 AS x, j + cos(i * k) / 4 AS y, -k + sin(i + j) / 4 AS z,
              300 + 40 * k + 10 * i + 30 * sin(j) AS vs
              FROM generate_series(0, 12) AS i, generate_series(0, 10) AS j, generate_series(0, 6) AS k', dimension => 3)`);
}

/** A server of a mesh at any port; fetch() asks it. */
export async function serve(mesh, options = {}) {
    const { port, stop } = await start({ mesh, srid: 0, edit: false, timeout: 20, port: 0, host: "127.0.0.1", ...options });
    const origin = `http://127.0.0.1:${port}`;
    const get = async (path, more) => {
        const response = await fetch(origin + path, { signal: AbortSignal.timeout(120_000), ...more });
        return { status: response.status, body: await response.json() };
    };
    const post = (name, body, session) => get(`/edit/${name}`, { method: "POST", body: JSON.stringify(body ?? {}),
        headers: { "Content-Type": "application/json", ...(session && { "X-Session": session }) } });
    return { origin, stop, get, post };
}

/** A way to the database that can break. break() ends all connections without a word, as a killed backend does, and
    `open = false` lets no other in. `onCommit` sees each COMMIT before the server does: it may send it on, and break. */
export async function fragileWay() {
    const folder = mkdtempSync(join(tmpdir(), "viewer-")), { PGHOST: host = "/var/run/postgresql", PGPORT: port = "5432" } = process.env;
    const way = { open: true, onCommit: null, sockets: new Set(), dbname: `host=${folder} port=5432` };
    const listener = net.createServer((client) => {
        if (!way.open) return client.destroy();
        const server = host.startsWith("/") ? net.connect(join(host, `.s.PGSQL.${port}`)) : net.connect(Number(port), host);
        for (const [from, to] of [[client, server], [server, client]]) {
            way.sockets.add(from);
            from.on("error", () => {});
            from.on("close", () => { way.sockets.delete(from); to.destroy(); });
        }
        server.on("data", (data) => client.write(data));
        client.on("data", (data) => (way.onCommit && data.includes("COMMIT\0") ? way.onCommit(() => server.write(data), server) : server.write(data)));
    });
    await new Promise((resolve) => listener.listen(join(folder, ".s.PGSQL.5432"), resolve));
    way.break = () => { for (const socket of way.sockets) socket.destroy(); };
    way.close = async () => {
        way.break();
        await new Promise((resolve) => listener.close(resolve));
        rmSync(folder, { recursive: true, force: true });
    };
    return way;
}

/** A session of its own, for locks and looks at what others do. */
export async function connect() {
    const client = new pg.Client({});
    await client.connect();
    return client;
}

/** Drops a mesh. psql() would stop this process, and with it the servers: a page that reads the mesh then would never let go of it. */
export async function drop(mesh) {
    const client = await connect();
    await client.query(`SET client_min_messages = warning; DROP TABLE ${mesh} CASCADE`);
    await client.end();
}

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
/** The same, which keeps no process running that has nothing else to do. */
const deadline = (ms) => new Promise((resolve) => setTimeout(resolve, ms).unref());

/** Waits for a condition; long enough for a machine that has much else to do. A condition that never answers does not hold. */
export async function eventually(condition, what, most = 30_000) {
    for (const until = Date.now() + most; Date.now() < until; await pause(50))
        if (await Promise.race([condition(), deadline(until - Date.now())])) return;
    throw new Error(`not within ${most / 1000} seconds: ${what}`);
}
