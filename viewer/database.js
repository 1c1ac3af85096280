// Connections to the database. Those that read are a small pool, read-only, with a limit on the time
// of a statement. What may take long, and is done once for all, has other connections, without a limit.
// Changes that are not saved have a connection of their own (edits.js). A client that goes away cancels
// its statement. A connection that breaks ends the statements on it, never the server.
import pg from "pg";
import { Sessions } from "./edits.js";
import { ask, Away, Refused } from "./errors.js";

const mostReaders = 4;
const lockWait = 1000; // ms: another change of a few points is over by then
const slack = 10_000; // ms beyond the limit of a statement: then the network is broken
const mostLong = 2;
const forever = 2 ** 31 - 1; // ms: pg takes 0 as its default

export class Database {
    constructor(config, { timeout, edit, idle = 600_000, absent = 120_000 }) {
        this.config = { ...config, application_name: "abacus viewer", connectionTimeoutMillis: 10_000, keepAlive: true, query_timeout: timeout + slack };
        Object.assign(this, { timeout, edit, idle });
        this.pool = this.connections({ max: mostReaders });
        this.long = this.connections({ max: mostLong, connectionTimeoutMillis: 0 }); // requests wait until one is free
        this.ending = new AbortController();
        this.sessions = new Sessions(this, { idle, absent });
        this.prepared = new WeakSet();
    }

    connections(options) {
        const pool = new pg.Pool({ ...this.config, ...options });
        pool.on("error", () => {}); // an idle connection that is gone is replaced
        pool.on("connect", (client) => client.on("error", () => {})); // one in use: what is asked on it fails
        return pool;
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
        await ask(client, `SELECT set_config('default_transaction_read_only', $1, false), set_config('statement_timeout', $2, false),
            set_config('idle_in_transaction_session_timeout', $3, false), set_config('lock_timeout', $4, false),
            set_config('search_path', (SELECT quote_ident(nspname) FROM pg_extension JOIN pg_namespace AS n ON n.oid = extnamespace
                                       WHERE extname = 'abacus') || ', pg_temp', false)`,
            [readOnly ? "on" : "off", String(this.timeout), String(this.idle + 60_000), String(readOnly ? 0 : lockWait)]);
        this.prepared.add(client);
    }

    /** Rows of a statement, for the session of this token or any reader; `signal` cancels it. */
    rows(token, text, values, signal) {
        return this.read(token, (query) => query(text, values), signal);
    }

    /** Runs task(query), all of it in one state of the database. */
    read(token, task, signal) {
        const session = token && this.sessions.get(token);
        return session?.edit ? session.read(task, signal) : this.readSaved(task, signal);
    }

    /** The same of what is saved, once for all: it goes on when a client leaves. */
    alone(task) {
        return this.readSaved(task, this.ending.signal, this.long);
    }

    /** Whether a session has changes that are not saved. */
    isEditing(token) {
        return Boolean(token && this.sessions.get(token).edit);
    }

    async readSaved(task, signal, pool = this.pool) {
        const client = await this.connect(pool);
        let isBroken = false;
        try {
            await this.prepare(client, true);
            await ask(client, "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY");
            const result = await task(this.query(client, signal));
            await ask(client, "COMMIT");
            return result;
        } catch (error) {
            isBroken = error instanceof Away || !(await ask(client, "ROLLBACK").then(() => true, () => false));
            throw error;
        } finally {
            client.release(isBroken);
        }
    }

    async connect(pool) {
        try {
            return await pool.connect();
        } catch (error) {
            // So the pool says that all its connections are in use.
            throw error.message.startsWith("timeout exceeded") ? new Refused(503, "too many requests are waiting for the database") : new Away(error);
        }
    }

    /** A connection that may write; `broken` is called when it breaks. */
    async connectWriter(broken) {
        const client = new pg.Client(this.config);
        client.on("error", broken);
        try {
            await client.connect().catch((error) => { throw new Away(error); });
            await this.prepare(client, false);
            return client;
        } catch (error) {
            client.end().catch(() => {});
            throw error;
        }
    }

    /** A function that returns the rows of a statement. One that is long has no limit, and must be in a transaction. */
    query(client, signal) {
        return async (text, values, { isLong = false } = {}) => {
            let cancelled;
            const cancel = () => { cancelled = this.cancel(client.processID); };
            signal?.addEventListener("abort", cancel);
            try {
                if (signal?.aborted) throw new Refused(499, "the client went away");
                if (isLong) await ask(client, "SET LOCAL statement_timeout = 0");
                const { rows } = await ask(client, isLong ? { text, values, query_timeout: forever } : { text, values });
                if (isLong) await ask(client, `SET LOCAL statement_timeout = ${this.timeout}`);
                return rows;
            } finally {
                signal?.removeEventListener("abort", cancel);
                await cancelled; // before somebody else gets the connection
            }
        };
    }

    async cancel(process) {
        const client = new pg.Client(this.config);
        client.on("error", () => {});
        try {
            await client.connect();
            await client.query("SELECT pg_cancel_backend($1)", [process]);
        } catch (error) {
            console.error(`viewer: ${error.message}`);
        } finally {
            await client.end().catch(() => {});
        }
    }

    /** Begins a session that edits, of a client; its token. */
    open(client) {
        if (!this.edit) return Promise.reject(new Refused(403, "the viewer was started without --edit"));
        return Promise.resolve(this.sessions.begin(client));
    }

    async end() {
        this.ending.abort();
        await this.sessions.end();
        await Promise.all([this.pool.end(), this.long.end()]);
    }
}
