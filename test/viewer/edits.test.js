// Pages that edit: who may, how long unsaved changes are kept, and what happens to them and to all others when a
// connection breaks or the database is unreachable.
import assert from "node:assert/strict";
import { after, before, mock, test } from "node:test";
import { Database } from "../../viewer/database.js";
import { connect, eventually, fragileWay, makeMeshes, psql, serve } from "./support.js";

const at = [400817.5, 5200740.5], elsewhere = [400917.5, 5200740.5];
const count = () => Number(psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'"));
const open = () => psql("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND state LIKE 'idle in transaction%'");
const begin = async (server) => (await server.post("begin")).body.session;
/** Adds a point; what the server answers. */
const insert = (server, session, id = "77", place = at) => server.post("insert", { id, at: place }, session);

let editing, way, fragile, said;
before(async () => {
    makeMeshes();
    said = mock.method(console, "error", () => {}); // the servers report broken connections
    editing = await serve("terrain", { edit: true });
    way = await fragileWay();
    fragile = await serve("terrain", { edit: true, dbname: way.dbname });
});
after(async () => {
    await editing?.stop();
    await fragile?.stop();
    await way?.close();
});

test("sessions that change nothing keep nobody out", async () => {
    const sessions = [];
    for (let i = 0; i < 100; ++i) sessions.push(await begin(editing));
    assert.equal((await insert(editing, sessions[99])).status, 200);
    assert.equal(open(), "1");
    for (let i = 0; i < 100; ++i) assert.equal((await editing.post("begin")).status, 200);
    assert.deepEqual((await editing.post("undo", {}, sessions[99])).body, { changes: 1 }); // a session with changes is kept
    assert.equal(open(), "0");
    assert.equal((await insert(editing, sessions[0])).status, 410); // the oldest without changes is forgotten, so they stay few
});

test("while a page has changes another is refused at once, and not when they are saved or undone", async () => {
    const [one, other] = [await begin(editing), await begin(editing)];
    for (const finish of ["save", "undo", "end"]) {
        assert.equal((await insert(editing, one)).status, 200);
        const { status, body } = await insert(editing, other, "78", elsewhere);
        assert.equal(status, 423);
        assert.match(body.error, /another page has unsaved changes/);
        assert.match(body.hint, /nobody uses that page for 10 minutes/);
        assert.equal(body.changes, 0);
        assert.equal((await editing.get("/api/locate?x=400817&y=5200740", { headers: { "X-Session": other } })).status, 200);
        assert.equal((await editing.post(finish, {}, one)).status, 200);
        assert.deepEqual((await insert(editing, other, "78", elsewhere)).body, { changes: 1 });
        assert.equal((await editing.post("undo", {}, other)).status, 200);
        if (finish === "save") psql(`SELECT abacus_delete('terrain', 'SELECT 77, ${at}')`);
    }
});

test("of changes by two pages at the same time one is made", async () => {
    const sessions = [await begin(editing), await begin(editing), await begin(editing)];
    const answers = await Promise.all(sessions.map((session) => insert(editing, session)));
    assert.deepEqual(answers.map(({ status }) => status).sort(), [200, 423, 423]);
    for (const session of sessions) await editing.post("end", {}, session);
});

test("a change that fails keeps nobody out", async () => {
    const [one, other] = [await begin(editing), await begin(editing)];
    const { status, body } = await editing.post("remove", { id: "999999999", at }, one);
    assert.equal(status, 409);
    assert.equal(body.changes, 0);
    assert.equal((await insert(editing, other)).status, 200);
    await editing.post("end", {}, other);
});

test("who changes the mesh elsewhere is named, and soon", async () => {
    const locker = await connect(), session = await begin(editing);
    try {
        await locker.query(`BEGIN; SELECT abacus_insert('terrain', 'SELECT 5, ${elsewhere}, 900')`);
        const { status, body } = await insert(editing, session);
        assert.equal(status, 423);
        assert.match(body.error, /another transaction/);
    } finally {
        await locker.query("ROLLBACK");
        await locker.end();
    }
    assert.equal((await insert(editing, session)).status, 200);
    await editing.post("end", {}, session);
});

test("what is not saved is undone when the page does not report, or nobody is at it", async () => {
    for (const [limits, alive, why] of [[{ absent: 2 }, false, "the page did not report for 2 seconds"], [{ idle: 2, absent: 60 }, true, "nobody used the page for 2 seconds"]]) {
        const server = await serve("terrain", { edit: true, ...limits }), before = count();
        try {
            const session = await begin(server);
            await insert(server, session);
            await eventually(async () => {
                if (alive) await server.post("alive", {}, session);
                return open() === "0";
            }, "the change is undone");
            for (const answer of [await server.post("alive", {}, session), await server.get("/api/info", { headers: { "X-Session": session } }), await server.post("save", {}, session)])
                assert.deepEqual(answer, { status: 410, body: { error: `${why}; 1 unsaved change was undone`, changes: 0, lost: 1 } });
            assert.equal(count(), before);
            assert.equal((await insert(server, await begin(server))).status, 200);
        } finally {
            await server.stop();
        }
    }
});

test("a page that reports, and is used, keeps its changes", async () => {
    const server = await serve("terrain", { edit: true, absent: 3, idle: 3 });
    try {
        const session = await begin(server);
        await insert(server, session);
        for (const until = Date.now() + 4000; Date.now() < until;) {
            await new Promise((resolve) => setTimeout(resolve, 200));
            assert.equal((await server.get("/api/info", { headers: { "X-Session": session } })).status, 200);
        }
        assert.deepEqual((await server.post("undo", {}, session)).body, { changes: 1 });
    } finally {
        await server.stop();
    }
});

test("a page that goes can say so without a header", async () => {
    const session = await begin(editing);
    await insert(editing, session);
    assert.equal((await editing.post("end", { session })).status, 200);
    assert.equal(open(), "0");
    assert.equal((await editing.post("save", {}, session)).status, 410);
});

test("when the connection of a page breaks its changes are lost, and it is told; all others go on", async () => {
    const before = count(), [one, other] = [await begin(fragile), await begin(fragile)];
    await insert(fragile, one);
    await insert(fragile, one, "78", elsewhere);
    way.break();
    for (const { status, body } of [await fragile.get("/api/info", { headers: { "X-Session": one } }), await fragile.post("save", {}, one), await insert(fragile, one, "79")]) {
        assert.equal(status, 410);
        assert.match(body.error, /the connection to the database broke; 2 unsaved changes were lost/);
        assert.deepEqual([body.changes, body.lost], [0, 2]);
    }
    await eventually(async () => (await fragile.get("/api/locate?x=400817&y=5200740")).status === 200, "an answer");
    await eventually(async () => (await insert(fragile, other)).status === 200, "another page has the mesh"); // the server has to notice, too
    assert.deepEqual((await fragile.post("undo", {}, other)).body, { changes: 1 });
    assert.equal(count(), before);
});

test("while the database is away the answer is 503, and then all is as before", async () => {
    said.mock.resetCalls();
    const session = await begin(fragile);
    way.open = false;
    way.break();
    for (const path of ["/api/info", "/api/locate?x=400817&y=5200740", "/tiles/picture/3/4/3"])
        assert.deepEqual(await fragile.get(path), { status: 503, body: { error: "the database cannot be reached" } });
    assert.equal((await fetch(fragile.origin)).status, 200); // files of the page are still served
    assert.deepEqual(await insert(fragile, session), { status: 503, body: { error: "the database cannot be reached", changes: 0 } });
    assert.deepEqual((await fragile.post("undo", {}, session)).body, { changes: 0 });
    way.open = true;
    await eventually(async () => (await fragile.get("/api/info")).status === 200, "an answer");
    assert.deepEqual((await insert(fragile, session)).body, { changes: 1 }); // the session has lost nothing
    assert.deepEqual((await fragile.post("undo", {}, session)).body, { changes: 1 });
    for (const { arguments: words } of said.mock.calls) assert.doesNotMatch(words.map((word) => word?.stack ?? String(word)).join(" "), /\n/);
});

test("requests that wait for a connection which breaks are answered", async () => {
    const locker = await connect();
    try {
        await locker.query("BEGIN; LOCK TABLE terrain IN ACCESS EXCLUSIVE MODE");
        const asked = Array.from({ length: 6 }, () => fragile.get("/api/locate?x=400817&y=5200740"));
        await eventually(() => psql("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND wait_event_type = 'Lock'") === "4", "they wait");
        way.break();
        await locker.query("ROLLBACK");
        assert.deepEqual((await Promise.all(asked)).map(({ status }) => status).sort(), [200, 200, 503, 503, 503, 503]);
    } finally {
        await locker.end();
    }
});

test("whether changes are saved is found out when the connection breaks in between", async () => {
    const before = count();
    for (const [isSent, status] of [[true, 200], [false, 410]]) {
        const session = await begin(fragile);
        await eventually(async () => (await insert(fragile, session)).status === 200, "a change");
        way.onCommit = (send, server) => {
            way.onCommit = null;
            if (!isSent) return way.break();
            server.removeAllListeners("data");
            server.on("data", way.break); // the answer gets lost
            send();
        };
        const answer = await fragile.post("save", {}, session);
        assert.equal(answer.status, status);
        if (isSent) assert.deepEqual(answer.body, { changes: 1 });
        else assert.match(answer.body.error, /1 unsaved change was lost/);
        assert.equal(count(), before + (isSent ? 1 : 0));
        if (isSent) psql(`SELECT abacus_delete('terrain', 'SELECT 77, ${at}')`);
    }
});

test("changes of a mesh that follows a table are refused, with the reason and the way", async () => {
    psql(`CREATE TABLE followed_points AS SELECT i AS id, i % 5 * 1.0 AS x, i / 5 * 1.0 AS y FROM generate_series(0, 24) AS i;
          SELECT abacus_create('followed', 2); SELECT abacus_track('followed', 'followed_points')`);
    const server = await serve("followed", { edit: true });
    try {
        const session = await begin(server);
        const { status, body } = await insert(server, session, "77", [1.5, 1.5]);
        assert.equal(status, 400); // as for every refusal by PostgreSQL
        assert.match(body.error, /points of mesh "followed" are rows of table "followed_points"/);
        assert.match(body.hint, /Change the table/);
        assert.equal((await server.get("/api/locate?x=1.2&y=1.1", { headers: { "X-Session": session } })).status, 200);
        assert.equal(psql("SELECT count(*) FROM abacus_vertices('followed')"), "25");
        psql("INSERT INTO followed_points VALUES (77, 1.5, 1.5)"); // the writers of the table do not have to wait
    } finally {
        await server.stop();
        psql("DROP TABLE followed_points, followed, followed_vertices");
    }
});

test("a save that PostgreSQL refuses says why, and what is undone", async () => {
    psql(`CREATE TABLE guarded (id int);
          CREATE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE 'the mesh follows a table' USING ERRCODE = '55000', HINT = 'Change the table.'; END $$;
          CREATE CONSTRAINT TRIGGER late AFTER INSERT ON guarded DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION refuse()`);
    const database = new Database({}, { timeout: 20_000, edit: true });
    try {
        const session = database.sessions.get(await database.open("here"));
        await session.change((query) => query("INSERT INTO public.guarded VALUES (1)"));
        await assert.rejects(session.save(), { code: "55000", message: "the mesh follows a table", hint: "Change the table.", lost: 1 });
        assert.equal(session.changes, 0);
        assert.equal(await session.save(), 0);
        assert.equal(database.sessions.holder, null);
    } finally {
        await database.end();
        psql("DROP TABLE guarded; DROP FUNCTION refuse");
    }
});
