// Connections to the database. Those that read are a small pool, read-only, with a limit on the time
// of a statement. Changes that are not saved have a connection of their own (edits.js). A client that
// goes away cancels its statement. A connection that breaks ends the statements on it, never the server.
import pg from "pg";
import { Sessions } from "./edits.js";
import { ask, Away, Refused } from "./errors.js";

const mostReaders = 4;
const lockWait = 1000; // ms: another change of a few points is over by then
const slack = 10_000; // ms beyond the limit of a statement: then the network is broken

export class Database {
    constructor(config, { timeout, edit, idle = 600_000, absent = 120_000 }) {
        this.config = { ...config, application_name: "abacus viewer", connectionTimeoutMillis: 10_000, keepAlive: true, query_timeout: timeout + slack };
        Object.assign(this, { timeout, edit, idle });
        this.pool = new pg.Pool({ ...this.config, max: mostReaders });
        this.pool.on("error", () => {}); // an idle connection that is gone is replaced
        this.pool.on("connect", (client) => client.on("error", () => {})); // one in use: what is asked on it fails
        this.sessions = new Sessions(this, { idle, absent });
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

    async readSaved(task, signal) {
        const client = await this.connect();
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

    async connect() {
        try {
            return await this.pool.connect();
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

    /** A function that returns the rows of a statement. */
    query(client, signal) {
        return async (text, values) => {
            let cancelled;
            const cancel = () => { cancelled = this.cancel(client.processID); };
            signal?.addEventListener("abort", cancel);
            try {
                if (signal?.aborted) throw new Refused(499, "the client went away");
                return (await ask(client, text, values)).rows;
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
        await this.sessions.end();
        await this.pool.end();
    }
}
