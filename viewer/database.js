// Connections to the database. Those that read are a small pool, read-only, with a limit on the time
// of a statement. A session that edits has a connection of its own, with one transaction from the
// first change until it is saved or undone. Whoever goes away cancels what was asked.
import { randomBytes } from "node:crypto";
import pg from "pg";

const mostReaders = 4, mostEditors = 8;
const idleMinutes = 10;

export class Refused extends Error {
    constructor(status, message, hint) {
        super(message);
        Object.assign(this, { status, hint });
    }
}

export class Database {
    constructor(config, { timeout, edit }) {
        this.config = { ...config, application_name: "abacus viewer", connectionTimeoutMillis: 10_000 };
        this.timeout = timeout;
        this.edit = edit;
        this.pool = new pg.Pool({ ...this.config, max: mostReaders });
        this.pool.on("error", () => {}); // an idle connection that is gone is replaced
        this.editors = new Map();
        this.prepared = new WeakSet();
    }

    /** The oid of a mesh by its name, as the user's search_path has it. */
    async resolve(name) {
        const client = new pg.Client(this.config);
        client.on("error", () => {});
        try {
            await client.connect();
            return (await client.query("SELECT $1::regclass::oid AS oid", [name])).rows[0].oid;
        } finally {
            await client.end().catch(() => {});
        }
    }

    /** Functions are the extension's, whatever else is called so. */
    async prepare(client, readOnly) {
        if (this.prepared.has(client)) return;
        await client.query(`SELECT set_config('default_transaction_read_only', $1, false), set_config('statement_timeout', $2, false),
            set_config('idle_in_transaction_session_timeout', $3, false),
            set_config('search_path', (SELECT quote_ident(nspname) FROM pg_extension JOIN pg_namespace AS n ON n.oid = extnamespace
                                       WHERE extname = 'abacus') || ', pg_temp', false)`,
            [readOnly ? "on" : "off", String(this.timeout), `${idleMinutes}min`]);
        this.prepared.add(client);
    }

    /** Rows of a statement, for the session of this token or any reader; `signal` cancels it. */
    async rows(token, text, values, signal) {
        const editor = token && this.editors.get(token);
        if (token && !editor) throw new Refused(410, "this session has ended; what it had not saved is undone");
        if (editor) return editor.rows(text, values, signal);
        const client = await this.connect();
        let broken;
        try {
            await this.prepare(client, true);
            return await this.run(client, text, values, signal);
        } catch (error) {
            broken = error.code ? undefined : error; // not the server's word: the connection is gone
            throw error;
        } finally {
            client.release(broken);
        }
    }

    async connect() {
        try {
            return await this.pool.connect();
        } catch (error) {
            console.error(error.message);
            throw new Refused(503, "the database cannot be reached");
        }
    }

    async run(client, text, values, signal) {
        let cancelled;
        const cancel = () => { cancelled = this.cancel(client.processID); };
        signal?.addEventListener("abort", cancel);
        try {
            if (signal?.aborted) throw new Refused(499, "the client went away");
            return (await client.query(text, values)).rows;
        } finally {
            signal?.removeEventListener("abort", cancel);
            await cancelled; // before somebody else gets the connection
        }
    }

    async cancel(process) {
        const client = new pg.Client(this.config);
        client.on("error", () => {});
        try {
            await client.connect();
            await client.query("SELECT pg_cancel_backend($1)", [process]);
        } catch (error) {
            console.error(error.message);
        } finally {
            await client.end().catch(() => {});
        }
    }

    /** Begins a session that edits; its token. */
    async open() {
        if (!this.edit) throw new Refused(403, "the viewer was started without --edit");
        if (this.editors.size >= mostEditors) throw new Refused(503, "too many sessions edit");
        const client = new pg.Client(this.config);
        const token = randomBytes(24).toString("base64url");
        const editor = new Editor(this, client, () => this.editors.delete(token));
        this.editors.set(token, editor);
        try {
            await client.connect();
            await this.prepare(client, false);
        } catch (error) {
            editor.close();
            throw error;
        }
        return token;
    }

    editor(token) {
        const editor = this.editors.get(token);
        if (!editor) throw new Refused(410, "this session has ended; what it had not saved is undone");
        return editor;
    }

    async end() {
        for (const editor of this.editors.values()) await editor.close();
        await this.pool.end();
    }
}

class Editor {
    constructor(database, client, ended) {
        Object.assign(this, { database, client, ended, changes: 0, last: Promise.resolve() });
        client.on("error", () => this.close());
        this.touch();
    }

    touch() {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.close(), idleMinutes * 60_000);
        this.timer.unref();
    }

    /** One after the other. */
    queue(task) {
        this.touch();
        const result = this.last.then(task);
        this.last = result.catch(() => {});
        return result;
    }

    /** A statement that fails undoes itself, not what was before. */
    async guarded(task) {
        if (this.changes === 0) return task();
        await this.client.query("SAVEPOINT viewer");
        try {
            const result = await task();
            await this.client.query("RELEASE SAVEPOINT viewer");
            return result;
        } catch (error) {
            await this.client.query("ROLLBACK TO SAVEPOINT viewer");
            throw error;
        }
    }

    rows(text, values, signal) {
        return this.queue(() => this.guarded(() => this.database.run(this.client, text, values, signal)));
    }

    /** Runs task(query), all of it or nothing, in the session's transaction. */
    change(task) {
        return this.queue(async () => {
            const isFirst = this.changes++ === 0;
            if (isFirst) await this.client.query("BEGIN");
            try {
                return await this.guarded(() => task(async (text, values) => (await this.client.query(text, values)).rows));
            } catch (error) {
                --this.changes;
                if (isFirst) await this.client.query("ROLLBACK");
                throw error;
            }
        });
    }

    finish(command) {
        return this.queue(async () => {
            const changes = this.changes;
            this.changes = 0;
            if (changes > 0) await this.client.query(command);
            return changes;
        });
    }
    save() { return this.finish("COMMIT"); }
    undo() { return this.finish("ROLLBACK"); }

    async close() {
        clearTimeout(this.timer);
        this.ended();
        await this.client.end().catch(() => {}); // PostgreSQL rolls back what is open
    }
}
