/** A catalogue as the check reads it: which messages it has, and what arguments each takes. */
import { FluentParser, type Junk, type Message, type VariableReference, Visitor } from "@fluent/syntax";

/** Names of arguments by message; `faults` are what could not be read. */
export type Catalogue = Map<string, Set<string>>;

/** Reads a catalogue; throws at what is no message. */
export function read(text: string): Catalogue {
  const catalogue: Catalogue = new Map();
  class Reader extends Visitor {
    #args = new Set<string>();
    visitMessage(message: Message): void {
      if (catalogue.has(message.id.name)) throw new Error(`${message.id.name} is there twice`);
      this.#args = new Set();
      catalogue.set(message.id.name, this.#args);
      this.genericVisit(message);
    }
    visitVariableReference(reference: VariableReference): void {
      this.#args.add(reference.id.name);
    }
    visitJunk({ content, annotations }: Junk): void {
      throw new Error(`no message: ${content.trim().split("\n")[0]} (${annotations.map((a) => a.message).join("; ")})`);
    }
  }
  new Reader().visit(new FluentParser().parse(text));
  return catalogue;
}

/** What is wrong: messages that a language lacks or that English has not, other arguments, messages that no source names. */
export function faults(catalogues: Record<string, Catalogue>, sources: string): string[] {
  const english = catalogues.en ?? new Map<string, Set<string>>();
  const said = new Set([...sources.matchAll(/"([a-z][a-z0-9-]*)"/g)].map(([, word]) => word ?? ""));
  const found = [...english.keys()].filter((id) => !said.has(id)).map((id) => `${id} is said nowhere`);
  for (const [language, catalogue] of Object.entries(catalogues)) {
    for (const id of english.keys()) if (!catalogue.has(id)) found.push(`${language} has no ${id}`);
    for (const [id, args] of catalogue) {
      const expected = english.get(id);
      if (expected === undefined) found.push(`${language} has ${id}, which English has not`);
      else if (list(args) !== list(expected)) found.push(`${language}'s ${id} takes ${list(args)}, and English's ${list(expected)}`);
    }
  }
  return found;
}

const list = (args: Set<string>) => (args.size === 0 ? "nothing" : [...args].sort().join(", "));

/** The messages' types, as a declaration file. */
export function types(catalogue: Catalogue): string {
  const line = ([id, args]: [string, Set<string>]) =>
    `  "${id}": ${
      args.size === 0
        ? "null"
        : `{ ${[...args]
            .sort()
            .map((name) => `${name}: string | number`)
            .join("; ")} }`
    };`;
  return `// Made from en.ftl by \`npm run check\`; not committed.\nexport interface Messages {\n${[...catalogue].map(line).join("\n")}\n}\n`;
}
