// Where the database is: a conninfo string as libpq takes it, `host=… dbname=…` or a URI, for the
// package pg. What it does not say is in the environment (PGHOST and so on), as always; otherwise the server is
// this machine's, reached by its socket if it has one, and the user is the one who calls.
import { readdirSync } from "node:fs";
import { userInfo } from "node:os";
import pg from "pg";

const names = { host: "host", hostaddr: "host", port: "port", dbname: "database", user: "user", password: "password",
    application_name: "application_name", sslmode: "sslmode", options: "options" };

/** The words of `key = value` with quotes and backslashes as libpq reads them. */
function pairs(text) {
    const found = [];
    const pair = /\s*([a-z_]+)\s*=\s*(?:'((?:[^'\\]|\\.)*)'|((?:[^\s'\\]|\\.)*))\s*/gy;
    while (pair.lastIndex < text.length) {
        const at = pair.lastIndex;
        const match = pair.exec(text);
        if (!match || match[0] === "") throw new Error(`cannot read the connection string at "${text.slice(at)}"`);
        found.push([match[1], (match[2] ?? match[3]).replace(/\\(.)/g, "$1")]);
    }
    return found;
}

/** The first folder with a server's socket, among those where libpq of Debian and of PostgreSQL looks. */
export function folderOfSocket(folders = ["/var/run/postgresql", "/tmp"]) {
    return folders.find((folder) => {
        try {
            return readdirSync(folder).some((name) => name.startsWith(".s.PGSQL."));
        } catch {
            return false;
        }
    });
}

export function connection(text) {
    pg.defaults.host = folderOfSocket() ?? "localhost";
    pg.defaults.user ??= userInfo().username;
    if (!text) return {};
    if (/^postgres(ql)?:\/\//.test(text)) return { connectionString: text };
    if (!text.includes("=")) return { database: text };
    const config = {};
    for (const [key, value] of pairs(text)) {
        if (!names[key]) throw new Error(`the connection string has "${key}", which the viewer does not know`);
        if (key === "sslmode") {
            if (value === "disable") config.ssl = false;
            else if (value === "require") config.ssl = { rejectUnauthorized: false };
            else if (value.startsWith("verify")) config.ssl = true;
        } else config[names[key]] = value;
    }
    return config;
}
