// Generated from openapi.json by `npm run types`; do not edit. 62ecec18c95c400186b5e28a660ee2ca75a4af4fccc819c3f86264645609bd81 976d6c3620011eeb9c667203568452100411ef56402794564178d9cd3f0fd4c6
export interface paths {
    "/api/v1/auth/session": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Who is signed in. */
        get: operations["get_signed_in"];
        put?: never;
        /**
         * Sign in: the answer sets the cookie `kelir_session`, for twelve hours.
         * @description After wrong passwords an answer takes longer, up to some seconds; nobody is locked out.
         */
        post: operations["sign_in"];
        /** Sign out; whoever is not signed in stays so. */
        delete: operations["sign_out"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/docs": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Go on to `docs/`. */
        get: operations["find_docs"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/docs/": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** This document as a page. */
        get: operations["get_docs"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/docs/style.css": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The page's style. */
        get: operations["get_docs_style"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/integrity": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What is damaged of all that is stored, as of the last look. */
        get: operations["get_integrity"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/openapi.json": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** This document. */
        get: operations["get_openapi"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/papers/taylor-cameron": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The survey of Taylor and Cameron, its three tests computed again. */
        get: operations["get_taylor_cameron"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/previews/{session}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Where a preview stands. */
        get: operations["get_preview"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/previews/{session}/completion": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Finish a preview. Its code is none that a panel would take. */
        post: operations["complete_preview"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/previews/{session}/consent": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Give consent in a preview. */
        post: operations["consent_preview"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/previews/{session}/trials/{trial_index}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /** Answer a trial of a preview: checked as a session's, and stored nowhere. */
        put: operations["answer_preview"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/sessions/{session}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Where a session stands; asking keeps its place in the design.
         * @description Who comes back so late that somebody else has got that place, and has answered nothing yet, takes another one, with other trials.
         */
        get: operations["get_session"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/sessions/{session}/completion": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Finish a session whose every trial is stored; the code is the same each time. */
        post: operations["complete_session"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/sessions/{session}/consent": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Give consent; the first time counts. */
        post: operations["give_consent"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/sessions/{session}/stimuli/{address}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * The bytes of a stimulus as a session gets them; they never change. The address is the permission.
         * @description They are a line of JSON and then pictures, one after another. The line says `format` (2), `width`, `height`, `fps` (0 for a still), `loop`,
         *     `frames` (which picture each frame shows), `picture_type` and `picture_bytes` (the length of each picture). A picture after the first is
         *     a step from the one before it and twice as high: its upper half is added, its lower half then taken away. What follows the last picture means nothing.
         */
        get: operations["get_session_stimulus"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/sessions/{session}/trials/{trial_index}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /**
         * Answer a trial. The same answer may be sent again; another one is refused, and the first one stands.
         * @description Only the choice is asked of an answer: whatever else is in it is kept as it comes, and what breaks a rule of the schema is named in the
         *     responses' `flags` and stands in no other column. An acknowledgement means that the answer is on disk.
         */
        put: operations["put_answer"];
        /** Answer a trial, where what lies between browser and server lets no PUT pass: the same as PUT. */
        post: operations["post_answer"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The studies that are served, by id. */
        get: operations["list_studies"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What a study says of itself before anybody takes part. */
        get: operations["get_study"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/links": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /** Make a link by which a study may be tried by who has it. */
        post: operations["make_link"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/sessions": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Begin a session. The answer holds its token, which is told this once.
         * @description Where somebody with the same id has begun before, the study file says what happens: another session begins, flagged; the one that is there
         *     goes on, with a new token in place of the old one; or none does.
         *
         *     A reply can be lost: the same `Idempotency-Key` gives the session that it began again, with a new token in place of the old one, while it has
         *     no consent yet; then `already_begun`.
         */
        post: operations["create_session"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The versions of a study, the one that is served first. */
        get: operations["list_versions"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/codebook.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What each column of `responses.csv` is, as a table. */
        get: operations["get_codebook_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/codebook.json": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What each column of `responses.csv` is. */
        get: operations["get_codebook"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/document": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The full report as it is written: sections of texts, tables and figures, the same as in the files of it. */
        get: operations["get_document"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/events.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** One row for each thing that happened to a page while a trial was taken: lost focus, a resize, an input that did not count. */
        get: operations["get_events_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/events_codebook.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What each column of `events.csv` is, as a table. */
        get: operations["get_events_codebook_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/export.xlsx": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** Every table in one spreadsheet, with a codebook: numbers are numbers whatever language the reader's spreadsheet speaks. */
        get: operations["get_export_xlsx"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/pairs.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The choices as pwcmp reads them, one row a trial. */
        get: operations["get_pairs_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/participants.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * One row a session: who came, when, with what, how far, and whether their answers are judged. What each column is, is in
         *     `participants_codebook.csv`.
         */
        get: operations["get_participants_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/participants_codebook.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What each column of `participants.csv` is, as a table. */
        get: operations["get_participants_codebook_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/report": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The full report: every number there is. */
        get: operations["get_report"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/report.html": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The full report as one HTML file. */
        get: operations["get_report_html"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/report.md": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The full report as one Markdown file, its figures within. */
        get: operations["get_report_md"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/responses.csv": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** One row a trial, all that is known of it. */
        get: operations["get_responses_csv"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/versions/{version}/results": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** The results in short: the paper's test for each block, the scale, the stimuli. */
        get: operations["get_results"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/studies/{study}/visit": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /** What the link of this query makes of a visit to a study. The parameters are those of the link itself. */
        get: operations["get_visit"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/healthz": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Whether the server answers and can store: something is written, synced and taken away again.
         * @description `degraded` means that something stored is damaged and people can take part all the same; researchers are told what.
         */
        get: operations["get_health"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/stimuli/{sha256}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * The bytes of a stored stimulus, or of one frame of an animation, for researchers; they never change.
         * @description An animation is JSON (`application/vnd.kelir.animation+json`) that names its frames by hash.
         */
        get: operations["get_stimulus"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
}
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        /** @description That an answer is on disk. */
        Acknowledgement: {
            /** @description Always true: what is not stored is refused. */
            acknowledged: boolean;
            /** @description Whether more trials will be decided. */
            more: boolean;
            /**
             * Format: int32
             * @description The first decided trial without an answer; null when there is none.
             */
            next_trial: number | null;
            /** @description The decided trials from `known` on; none without `known`. */
            trials: components["schemas"]["Trial"][];
        };
        /** @description `[blocks.adaptive]`: the procedure, in the levels of the block's items. */
        Adaptive: {
            /** @enum {string} */
            procedure: "staircase";
            /**
             * Format: int32
             * @description Ends after so many reversals …
             */
            reversals: number;
            /**
             * Format: double
             * @description The level that comes first; absent: the easiest.
             */
            start?: number | null;
            /** @description By how many levels it moves, each until the next reversal and the last from then on. */
            steps: number[];
            /** @description Which answers move it. */
            track: components["schemas"]["Track"];
            /**
             * Format: int32
             * @description … and in any case after so many trials.
             */
            trials: number;
        } | {
            /**
             * Format: double
             * @description … or once the threshold's posterior standard deviation is below this, in levels.
             */
            precise_enough?: number | null;
            /** @enum {string} */
            procedure: "quest-plus";
            /**
             * Format: int32
             * @description Ends after so many trials …
             */
            trials: number;
        };
        /** @description The answer to a trial, as its kind asks. Keys beside these are kept as they come. */
        Answer: components["schemas"]["TwoAlternativeAnswer"] | components["schemas"]["TwoIntervalAnswer"];
        /** @description How the two pictures stood. */
        Arrangement: "side" | "stack" | "beside" | "below";
        /** @description How even the design came out, among those who are judged. */
        Balance: {
            /**
             * Format: int64
             * @description Places in the design that more than one participant has completed: who came back late to a place that somebody else had got meanwhile is
             *     kept, and counted here.
             */
            doubled_places: number;
            /**
             * Format: int64
             * @description Items of blocks with a fixed plan that have answers.
             */
            items: number;
            /** @description Items whose target did not come first in half of their answers, give or take the odd one. */
            uneven: components["schemas"]["UnevenItem"][];
        };
        /** @description What an exact binomial test says. */
        BinomialTest: {
            /**
             * Format: int64
             * @description Trials.
             */
            n: number;
            /**
             * Format: double
             * @description Two-sided p-value: the probability of all outcomes that are no likelier than this one (minimum likelihood; R's
             *     `binom.test`, with its tolerance of 1e-7 for equal likelihoods). It isn't twice a tail.
             */
            p: number;
            /**
             * Format: double
             * @description The probability of a success under the null hypothesis.
             */
            p0: number;
            /**
             * Format: double
             * @description P(X ≥ successes) under the null hypothesis.
             */
            p_greater: number;
            /**
             * Format: double
             * @description P(X ≤ successes) under the null hypothesis.
             */
            p_less: number;
            /**
             * Format: double
             * @description successes / n.
             */
            proportion: number;
            /**
             * Format: int64
             * @description Successes among them.
             */
            successes: number;
        };
        /** @description Pairs of the same two conditions, shown together and analysed together. */
        Block: components["schemas"]["TrialKind"] & {
            adaptive?: components["schemas"]["Adaptive"] | null;
            /** @description Whether the target is the right answer that attention alone is needed for; such a block screens and is not analysed. */
            catch?: boolean;
            /** @description The two conditions compared. */
            conditions: string[];
            /** @description Identifier, unique in the study. */
            id: string;
            /** @description The items, in file order: each is a scene shown under both conditions. */
            items: components["schemas"]["Item"][];
            /** @description Stills or animations. */
            kind: components["schemas"]["Kind"];
            psychometric?: components["schemas"]["Psychometric"] | null;
            /** @description The condition whose choices are counted, one of `conditions`. */
            target: string;
            /** @description Title for researchers. */
            title: string;
        };
        /** @description Order and speed in one block. */
        BlockOrder: {
            /** @description Block's id. */
            id: string;
            outliers?: components["schemas"]["Outliers"] | null;
            place?: components["schemas"]["WithinSlope"] | null;
            speed?: components["schemas"]["WithinSlope"] | null;
        };
        /** @description A block judged. */
        BlockReport: components["schemas"]["BlockSummary"] & {
            /** @description What is beside the paper's test. */
            analysis: components["schemas"]["ChoiceAnalysis"];
            /** @description Each item alone, with all who answered it; empty for an adaptive block, which shows one item many times. */
            by_item: components["schemas"]["ItemReport"][];
            first?: components["schemas"]["Proportion"] | null;
            first_intraclass?: components["schemas"]["Intraclass"] | null;
            /** @description The role that stands first: left, or the first interval. */
            first_role: components["schemas"]["Role"];
            /**
             * Format: double
             * @description p corrected by Holm's method for all planned tests but the primary endpoint, those that are not defined among them; of the primary endpoint
             *     p itself; null where p is, and of a test that was not planned.
             */
            p_holm?: number | null;
            pairs?: components["schemas"]["PairsReport"] | null;
            /** @description Whether its t-test was planned: of an adaptive block it never is, of one with a psychometric function where the file says so. */
            planned: boolean;
            /** @description Whether that test is the primary endpoint. */
            primary: boolean;
            psychometric?: components["schemas"]["PsychometricReport"] | null;
            rt_ms?: components["schemas"]["Quartiles"] | null;
            /** @description Their 1st to 99th percentile, interpolated likewise; empty without answers. */
            rt_percentiles_ms: number[];
        };
        /**
         * @description A block's choices of the target per participant, and the paper's two-tailed one-sample t-test of them.
         *
         *     Who counts: participants who answered *all* of the block's pairs, whether or not they went on to finish the study.
         */
        BlockSummary: {
            /** @description The two conditions. */
            conditions: string[];
            /** @description Number of target choices → number of participants, from 0 to `items`; empty for an adaptive block. */
            counts: {
                [key: string]: number;
            };
            /**
             * Format: double
             * @description Degrees of freedom n − 1; null when n < 2.
             */
            df?: number | null;
            /** @description Block's id. */
            id: string;
            /**
             * Format: int64
             * @description Participants who answered some but not all, left out.
             */
            incomplete: number;
            /** @description Number of items. */
            items: number;
            /** @description Stills or animations. */
            kind: components["schemas"]["Kind"];
            /** @description How the two pictures of its trials stand to each other, in words. */
            layout: string;
            /**
             * Format: double
             * @description Mean number of target choices; null when n = 0.
             */
            mean?: number | null;
            /**
             * Format: double
             * @description Expected number of someone who cannot tell: half the pairs.
             */
            mu: number;
            /**
             * Format: int64
             * @description Participants who answered all items, or went to the end of an adaptive procedure.
             */
            n: number;
            /** @description Why a number is null. */
            note?: string | null;
            /**
             * Format: double
             * @description Two-sided p; null where t is.
             */
            p?: number | null;
            /**
             * Format: double
             * @description Sample standard deviation (n − 1); null when n < 2.
             */
            sd?: number | null;
            /**
             * Format: double
             * @description (mean − mu) / (sd / √n); null when n < 2 or sd = 0.
             */
            t?: number | null;
            /** @description The condition whose choices are counted. */
            target: string;
            /** @description Block's title. */
            title: string;
            /** @description How its trials ask. */
            trial: components["schemas"]["TrialName"];
        };
        /** @description A bootstrap interval. */
        Bootstrap: {
            /**
             * Format: double
             * @description The statistic of the sample itself.
             */
            estimate: number;
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description Confidence level, e.g. 0.95.
             */
            level: number;
            /**
             * Format: double
             * @description Lower end, in the statistic's unit.
             */
            low: number;
            /** @description How the interval was read. */
            method: components["schemas"]["BootstrapMethod"];
            /** @description Resamples drawn. */
            replicates: number;
            /**
             * Format: int64
             * @description The seed that repeats it.
             */
            seed: number;
            /**
             * Format: double
             * @description Standard deviation of the replicates.
             */
            standard_error: number;
            /** @description Resamples in which the statistic was undefined, left out of the interval. */
            undefined: number;
        };
        /**
         * @description How the interval is read off the resampled statistics.
         * @enum {string}
         */
        BootstrapMethod: "percentile" | "bias-corrected" | "symmetric";
        /** @description What checking the stored answers found. */
        Chain: {
            /**
             * Format: int64
             * @description Answers that were blanked by a withdrawal.
             */
            blanked: number;
            /** @description Rows that are not what was written. */
            faults: components["schemas"]["Fault"][];
            /** @description Hash of the last row; noting it elsewhere also proves that no later rows were cut off. */
            head: string;
            /**
             * Format: int64
             * @description Rows that were checked.
             */
            rows: number;
        };
        /** @description Numbers of target choices per participant, judged. */
        ChoiceAnalysis: {
            bayes?: components["schemas"]["JzsBayesFactor"] | null;
            binomial?: components["schemas"]["BinomialTest"] | null;
            detectable?: components["schemas"]["TPlan"] | null;
            effect?: components["schemas"]["EffectSize"] | null;
            equivalence?: components["schemas"]["ShareEquivalence"] | null;
            intraclass?: components["schemas"]["Intraclass"] | null;
            mixed_logit?: components["schemas"]["MixedLogit"] | null;
            /** @description What is not defined and why, and what a reader must not conclude. */
            notes: string[];
            /** @description Power of this test with as many participants, for true effects of [`POWER_EFFECTS`]. */
            power: components["schemas"]["TPlan"][];
            proportion?: components["schemas"]["Proportion"] | null;
            robust_logit?: components["schemas"]["RobustLogit"] | null;
            sign?: components["schemas"]["BinomialTest"] | null;
            /** @description The paper's two-tailed t-test against half the pairs. */
            t_test: components["schemas"]["TTest"];
            wilcoxon?: components["schemas"]["SignedRank"] | null;
        };
        /** @description What the columns of a table are. */
        Codebook: {
            /** @description The columns, in the table's order. */
            columns: components["schemas"]["Column"][];
        };
        /** @description One coefficient on the log-odds scale. */
        Coefficient: {
            /**
             * Format: double
             * @description Log odds (ratio).
             */
            estimate: number;
            /**
             * Format: double
             * @description Upper end of the 95% interval.
             */
            high: number;
            /**
             * Format: double
             * @description Lower end of the 95% interval.
             */
            low: number;
            /**
             * Format: double
             * @description Two-sided p of estimate = 0.
             */
            p: number;
            /**
             * Format: double
             * @description Its standard error under the model named by the result.
             */
            standard_error: number;
            /**
             * Format: double
             * @description estimate / standard error.
             */
            statistic: number;
        };
        /** @description A column of a table, or a field of a record. */
        Column: {
            /** @description `text`, `number`, `integer`, `boolean`, `list` or `object`. */
            kind: string;
            /** @description What it says. */
            meaning: string;
            /** @description Its name. */
            name: string;
            /** @description Unit of its numbers; empty: none. */
            unit: string;
            /** @description The values that it can have; empty: any of its kind. */
            values?: components["schemas"]["Meaning"][];
        };
        /** @description One comparison of the paper, computed again. */
        Comparison: {
            /** @description Evidence for no effect against an effect. */
            bayes: components["schemas"]["JzsBayesFactor"];
            /** @description (PA images chosen, participants), reconstructed. */
            counts: [
                number,
                number
            ][];
            /** @description The effect that would be found with a probability of 80%. */
            detectable: components["schemas"]["TPlan"];
            /** @description Effect size with 95% intervals. */
            effect: components["schemas"]["EffectSize"];
            /** @description Is the share of PA images chosen equivalent to one half? The paper states no bound: by a range of them, rising. */
            equivalence: components["schemas"]["ShareEquivalence"][];
            /** @description `still-mc`, `still-photo` or `animation-mc`. */
            id: string;
            /**
             * Format: double
             * @description Its p-value, corrected for the three tests by Holm's method.
             */
            p_holm: number;
            /** @description Power at this number of participants for small, medium and large effects (d = 0.2, 0.5, 0.8), α = 0.05. */
            power: components["schemas"]["TPlan"][];
            /** @description What the paper prints. */
            printed: components["schemas"]["Printed"];
            /**
             * @description How many tables of counts, at this number of participants, round to the printed mean and sd: 1 when the
             *     reconstruction is unique.
             */
            reconstructions: number;
            /** @description Sign test of the same hypothesis, without assuming normality. */
            sign: components["schemas"]["BinomialTest"];
            /** @description Does its t round to the printed one? */
            t_as_printed: boolean;
            /** @description The paper's test. */
            test: components["schemas"]["OneSampleTTest"];
            /** @description What was compared. */
            title: string;
            /** @description Wilcoxon's signed-rank test, ties exact. */
            wilcoxon: components["schemas"]["SignedRank"];
        };
        /** @description The end of a session. */
        Completion: {
            /** @description The code that says so, the same each time. */
            completion_code: string;
            /** @description Where to go on to, if the study leads anywhere. */
            redirect?: string;
        };
        /** @description The code at the end and where it leads. */
        CompletionSettings: {
            /** @description One code for all (recruiting panels ask for it); absent: each session gets its own. */
            code?: string | null;
            /** @description Address to go on to; `[CODE]` and `[NAME]` of an address parameter are filled in. */
            redirect?: string | null;
        };
        /** @description Where the pictures of a condition come from. */
        Condition: {
            /** @description Settings of a simulated camera that photographs the drawn image. */
            camera?: {
                [key: string]: unknown;
            } | null;
            /** @description The technique's own settings, handed to the renderer as they are. `pa`, summed-area tables: `split` (a whole number from 1 to 64, 1 unless given): splits each emitter into K × K pieces, whose products over the puppets are averaged; 1 is the paper's way; `weights` (one of area and irradiance, "area" unless given): how the pieces weigh: area tends to the geometric visibility, irradiance to what a meter reads; `strips` (a whole number from 1 to 1024, 64 unless given): strips that a disk is cut into, each a rectangle of the strip's own area; `variant` (one of exact and shadow-map, "exact" unless given): tables of the puppets themselves, or of a shadow map drawn from the lamp, as in the paper; `map_size` in samples (a whole number from 16 to 8192, 1024 unless given): samples a side of a shadow map: of the lamp's (pa, variant shadow-map) or of each puppet's (pcss); `dome_steps` (a whole number from 2 to 128, 32 unless given): lattice points per distance of a puppet for the dome's light. `mc`, Monte Carlo, the ground truth: `spp` in samples a pixel (a whole number from 1 to 1048576, 64 unless given): samples a pixel and emitter in penumbra, rounded up to a multiple of 16 replicates; `seed` (a whole number, 1 unless given): seed of the sample points: same seed and count, same bytes; `target_error` in full scale (a number above 0 and below 1): in place of spp: enough samples for this root mean square error over penumbra; `time_limit_s` in s (a number above 0): in place of spp: as many samples as this time allows; the count is recorded and replays the image. `points`, point lights averaged: `lights` (a square number from 1 to 65536, 16 unless given): point lights that stand for each emitter; `subpixels` (a whole number from 1 to 8, 4 unless given): points along each side of an area pixel. `pcss`, percentage-closer soft shadows: `blocker_samples` (a whole number from 1 to 16384, 16 unless given): samples of the search for blockers; `filter_samples` (a whole number from 1 to 16384, 64 unless given): samples of the filter; `map_size` in samples (a whole number from 16 to 8192, 1024 unless given): samples a side of a shadow map: of the lamp's (pa, variant shadow-map) or of each puppet's (pcss); `seed` (a whole number, 1 unless given): seed of the sample points: same seed and count, same bytes; `bias_m` in m (a number from 0, 0.0 unless given): depth bias: a puppet no further than this before the screen casts no shadow. `oracle`, slow f64 sums, for crops and tests: `tolerance` (a number above 0 and up to 0.1, 0.0001 unless given): where nothing is a finite sum, emitter or pixel is subdivided until two levels differ by less than this; `geometric` (true or false, false unless given): draws what an emitter gives times its geometric visibility, as pa does, in place of the true irradiance. `raytrace`, rays, the ground truth of a stage: `spp` in samples a pixel (a whole number from 1 to 1048576, 64 unless given): samples a pixel and light where anything is estimated, rounded up to a multiple of 16 replicates; `seed` (a whole number, 1 unless given): seed of the sample points: same seed and count, same bytes; `bounces` (a whole number from 0 to 1, 0 unless given): how often light goes on from surface to surface. */
            knobs: {
                [key: string]: unknown;
            };
            /** @enum {string} */
            source: "rendered";
            /** @description Technique name, such as `pa` or `mc`. */
            technique: string;
        } | {
            /** @description By item id. */
            files: {
                [key: string]: components["schemas"]["Pictures"];
            };
            /** @enum {string} */
            source: "files";
        };
        /** @description A condition's interval, in JOD. */
        ConditionInterval: {
            /** @description Its name. */
            condition: string;
            /**
             * Format: double
             * @description Upper end, likewise.
             */
            high?: number | null;
            /**
             * Format: double
             * @description Position.
             */
            jod: number;
            /**
             * Format: double
             * @description Lower end; null where the observers give no interval.
             */
            low?: number | null;
            /**
             * Format: double
             * @description Standard error from leaving out each observer in turn; null likewise.
             */
            standard_error?: number | null;
        };
        /** @description How far observers contradict the one axis and themselves. */
        Consistency: {
            /**
             * Format: int64
             * @description Observers whose choices the scale of all the others was asked to predict; 0 with fewer than three or with more than
             *     2,000.
             */
            observers: number;
            /** @description Those whom it predicts far worse than the rest: to look at, not to exclude. */
            odd: components["schemas"]["ObserverFit"][];
            /** @description Circular triads over all observers. */
            triads: components["schemas"]["Triads"];
        };
        /**
         * @description The small-sample factor on the cluster-robust variance (Cameron & Miller 2015; names as in R's clubSandwich).
         * @enum {string}
         */
        Correction: "CR0" | "CR1" | "CR1S";
        /** @description A session that has just begun. */
        CreatedSession: components["schemas"]["SessionState"] & {
            /** @description The session's secret, for `Authorization: Bearer`; it is told this once. */
            token: string;
        };
        /** @description Participants' and pairs' log odds scatter normally: logit P = β + σᵤ zᵢ + σᵥ xⱼ for participant i and pair j, all z and x ~ N(0, 1). */
        CrossedLogit: {
            /**
             * Format: int64
             * @description Choices.
             */
            choices: number;
            /**
             * Format: double
             * @description One less than there are pairs, or participants where these are fewer: other samples are of both.
             */
            df: number;
            /**
             * Format: double
             * @description And at its upper end.
             */
            high: number;
            /**
             * Format: double
             * @description ln likelihood by Laplace's approximation.
             */
            log_likelihood: number;
            /** @description β, the log odds at the centre of participants and pairs; p and 95% interval from t with `df`. */
            log_odds: components["schemas"]["Coefficient"];
            /**
             * Format: double
             * @description The same at the lower end of the interval of β.
             */
            low: number;
            /**
             * Format: double
             * @description σᵥ, standard deviation of pairs' log odds.
             */
            pair_sd: number;
            /**
             * Format: int64
             * @description Pairs with choices.
             */
            pairs: number;
            /**
             * Format: double
             * @description σᵤ, standard deviation of participants' log odds.
             */
            participant_sd: number;
            /**
             * Format: int64
             * @description Participants with choices.
             */
            participants: number;
            /**
             * Format: double
             * @description Share of target choices over participants and pairs: the mean of P over both distributions.
             */
            share: number;
        };
        /** @description One point of a curve. */
        CurvePoint: {
            /**
             * Format: double
             * @description The level.
             */
            level: number;
            /**
             * Format: double
             * @description The share of target choices.
             */
            share: number;
        };
        /** @description How many participants had something. */
        DeviceCount: {
            /**
             * Format: int64
             * @description Participants.
             */
            participants: number;
            /** @description What it was; "not known" where the browser did not say. */
            value: string;
            /** @description What is counted, with its unit. */
            what: string;
        };
        /** @description The interval of a difference of two conditions, in JOD, and the test that there is none. */
        DifferenceInterval: {
            /** @description The condition subtracted from. */
            a: string;
            /** @description The condition subtracted. */
            b: string;
            /**
             * Format: double
             * @description Upper end, likewise.
             */
            high?: number | null;
            /**
             * Format: double
             * @description a − b.
             */
            jod: number;
            /**
             * Format: double
             * @description Lower end; null where the observers give no interval.
             */
            low?: number | null;
            /**
             * Format: double
             * @description Two-sided p of "no difference" by flipping the signs of observers' scores.
             */
            p: number;
            /** @description Whether every pattern of signs was tried. */
            p_exact: boolean;
            /**
             * Format: double
             * @description The same corrected by Holm's method for the number of pairs of conditions.
             */
            p_holm: number;
            /**
             * Format: double
             * @description The smallest p that so many observers, or so many random patterns of signs, can give.
             */
            p_smallest: number;
        };
        /** @description An item that pooled versions show in different ways under one condition. */
        DifferentStimulus: {
            /** @description Condition's name. */
            condition: string;
            /** @description Item's id. */
            item: string;
            /** @description The versions that show it otherwise than the first of the pooled ones, or not at all. */
            versions: string[];
        };
        /**
         * @description Which way a psychometric function runs.
         * @enum {string}
         */
        Direction: "rising" | "falling";
        /** @description In which sizes stimuli are made and shown. */
        Display: {
            /** @description What a page does with more room than a size fills. */
            fit: components["schemas"]["Fit"];
            /** @description Sizes [width, height] at which each stimulus is made, in pixels, by rising width. */
            sizes: number[][];
        };
        /** @description How stimuli stand on displays that differ, as far as the file says so. */
        DisplayRules: {
            fit?: components["schemas"]["Fit"] | null;
            /** @description Sizes [width, height] at which each stimulus is made, by rising width, in pixels; none: the study's `size` alone. */
            sizes?: number[][];
        };
        /** @description A whole report. Every text in it is plain: writers escape. */
        Document: {
            /** @description From the top down. */
            sections: components["schemas"]["Section"][];
            /** @description Below the title: which study and version this is of. */
            subtitle: string;
            /** @description Over everything. */
            title: string;
        };
        /** @description What a participant downloads of a version at one of its sizes. */
        Download: {
            /**
             * Format: int64
             * @description Bytes of all that may be shown.
             */
            bytes: number;
            /** @description Whether that takes more than half a minute on a slow line (1.6 Mbit/s). */
            is_heavy: boolean;
            /** @description [width, height] in pixels. */
            size: number[];
        };
        /** @description How far a mean lies from its null value, in standard deviations. */
        EffectSize: {
            /**
             * Format: double
             * @description Cohen's d = (mean − mu) / sd, with its sign. (For pairs: of the differences, also written d_z.)
             */
            d: number;
            /** @description Its interval, from the noncentral t distribution of t (Steiger & Fouladi 1997). */
            d_interval: components["schemas"]["Interval"];
            /**
             * Format: double
             * @description Hedges' g = J d, unbiased: J = Γ(ν/2) / (√(ν/2) Γ((ν − 1)/2)) with ν = n − 1 (Hedges 1981).
             */
            g: number;
            /** @description J times the interval of d. */
            g_interval: components["schemas"]["Interval"];
        };
        /** @description What two one-sided tests say (TOST, Schuirmann 1987). */
        Equivalence: {
            /**
             * Format: double
             * @description Half the width of the equivalence range, in units of the values.
             */
            half_width: number;
            /** @description The interval of mean − mu whose level is 1 − 2α with α = 0.05: inside the bounds exactly when p < 0.05. */
            interval_90: components["schemas"]["Interval"];
            /**
             * Format: double
             * @description The larger of the two p-values: below α, the mean is equivalent to mu within the bounds.
             */
            p: number;
            /**
             * Format: double
             * @description P(T ≥ t_lower).
             */
            p_lower: number;
            /**
             * Format: double
             * @description P(T ≤ t_upper).
             */
            p_upper: number;
            /**
             * Format: double
             * @description t against the lower bound, mean − mu > −half_width, and its one-sided p.
             */
            t_lower: number;
            /**
             * Format: double
             * @description t against the upper bound, mean − mu < half_width.
             */
            t_upper: number;
        };
        /** @description How far from one half a block's share of target choices may lie and still count as equivalent to it. */
        EquivalenceBound: {
            /** @description Why a smaller difference does not matter. */
            reason: string;
            /**
             * Format: double
             * @description Half the width of the range about ½, as a share of choices, above 0 and below ½.
             */
            within: number;
        };
        /**
         * @description What is maximised.
         * @enum {string}
         */
        Estimator: "automatic" | "maximum-likelihood" | "jeffreys";
        /** @description What happened. */
        EventKind: "blur" | "focus" | "hidden" | "visible" | "resize" | "orientation" | "fullscreen_enter" | "fullscreen_exit" | "ignored";
        /** @description A participant who is left out. */
        Excluded: {
            /** @description Whether the session was finished. */
            is_completed: boolean;
            /** @description Every reason there is. */
            reasons: components["schemas"]["Exclusion"][];
            /** @description Session's id. */
            session_id: string;
            /** @description The reasons in words. */
            why: string;
        };
        /** @description Why a participant is left out. */
        Exclusion: {
            /**
             * Format: int32
             * @description How many there may be.
             */
            allowed: number;
            /** @enum {string} */
            reason: "too_fast";
            /**
             * Format: int32
             * @description How many there were.
             */
            trials: number;
        } | {
            /**
             * Format: int32
             * @description How many there may be.
             */
            allowed: number;
            /** @enum {string} */
            reason: "failed_catch_trials";
            /**
             * Format: int32
             * @description How many there were.
             */
            trials: number;
        } | {
            /** @enum {string} */
            reason: "straight_lining";
            /**
             * Format: int32
             * @description How many trials there were.
             */
            trials: number;
        } | {
            /** @description What was noticed. */
            flag: components["schemas"]["Flag"];
            /** @enum {string} */
            reason: "flagged";
        } | {
            /**
             * Format: int32
             * @description How many trials were answered.
             */
            answered: number;
            /** @enum {string} */
            reason: "incomplete";
            /**
             * Format: int32
             * @description How many there are.
             */
            trials: number;
        };
        /** @description A stored answer that is not what was written. */
        Fault: {
            /**
             * Format: int32
             * @description Version of the chain: 1 (all studies in one, closed) or 2 (the study's own).
             */
            chain: number;
            /** @description What somebody who looked into it noted; null while it is unexplained. */
            note?: string | null;
            /**
             * Format: int64
             * @description Place in its chain, from 1.
             */
            seq: number;
            /** @description What is wrong with it. */
            what: string;
        };
        /** @description One thing that is wrong with a JSON value. */
        FieldError: {
            /** @description Where: a JSON Pointer (RFC 6901); empty for the whole. */
            pointer: string;
            /** @description The rule that it breaks, as words that follow the field's name. */
            rule: string;
            /** @description What was found there, long texts cut; absent where the field is missing, or secret. */
            value?: unknown;
        };
        /** @description A picture. */
        Figure: {
            /** @description What is seen, and what dots and lines are. */
            caption: string;
            /** @description A name for a file, such as `choices`. */
            name: string;
            /** @description SVG with a title and a description: shapes and texts alone, no script, style, link or id; its ground is white. */
            svg: string;
        };
        /** @description A test of what stood first. */
        FirstTest: {
            /**
             * Format: int64
             * @description Choices of what stood first.
             */
            chosen: number;
            /**
             * Format: int64
             * @description Participants who made them.
             */
            participants: number;
            /** @description By flipping the signs of participants' differences. */
            test: components["schemas"]["Flipped"];
            /**
             * Format: int64
             * @description Choices.
             */
            trials: number;
        };
        /** @description What a page does where there is more room than a size fills at one device pixel a stimulus pixel. */
        Fit: "native" | "integer" | "fill";
        /** @description What can be known of a session besides its answers. */
        Flag: "repeated_id" | "many_starts" | "faster_than_clock" | "no_response_time";
        /** @description How many sessions something was noticed of. */
        Flagged: {
            /** @description Whether the study's rules leave these out. */
            excludes: boolean;
            /** @description What was noticed. */
            flag: components["schemas"]["Flag"];
            /** @description What that means. */
            meaning: string;
            /**
             * Format: int64
             * @description Of how many sessions.
             */
            sessions: number;
        };
        /** @description The p of a sign-flip test. */
        Flipped: {
            /** @description Whether every pattern was tried. */
            exact: boolean;
            /**
             * Format: double
             * @description Two-sided p: of the patterns of signs, how many make the sum as large as it is.
             */
            p: number;
            /**
             * Format: double
             * @description The smallest p that the test can give.
             */
            smallest: number;
        };
        /** @description How an animation was shown. Its position is a function of time: frame n is due n / fps seconds after the first. */
        FrameLog: {
            /** @description What was shown when: frame, counted on through loops, and ms since the first frame, of each frame drawn, up to 600. */
            draws?: number[][] | null;
            /**
             * Format: double
             * @description Frames per second of the animation.
             */
            fps?: number | null;
            /**
             * Format: double
             * @description Refreshes that each frame was shown for, where pages counted these; they don't any more.
             */
            hold?: number | null;
            /**
             * Format: double
             * @description Longest time between two refreshes at which the page could draw.
             */
            longest_interval_ms?: number | null;
            /**
             * Format: double
             * @description Frames that were never drawn, or later than their time by more than a refresh.
             */
            missed_frames?: number | null;
            /**
             * Format: double
             * @description Refreshes at which the browser did not let the page draw.
             */
            missed_refreshes?: number | null;
            /**
             * Format: double
             * @description Refresh rate of the display, to which the nearest refresh of a frame's time is found.
             */
            refresh_hz?: number | null;
            /**
             * Format: double
             * @description Refreshes from the first frame to the choice.
             */
            refreshes?: number | null;
            /**
             * Format: double
             * @description Frames drawn.
             */
            shown?: number | null;
            /**
             * Format: double
             * @description Frames passed over without being drawn.
             */
            skipped?: number | null;
        };
        /** @description How stimuli stand on the page. */
        Geometry: {
            arrangement?: components["schemas"]["Arrangement"] | null;
            /**
             * Format: double
             * @description Width at which each stimulus stood, pinch zoom included: its width in pixels × scale / device_pixel_ratio.
             */
            css_width_px?: number | null;
            /**
             * Format: double
             * @description Device pixels per CSS pixel.
             */
            device_pixel_ratio?: number | null;
            /**
             * Format: double
             * @description Device pixels per stimulus pixel, pinch zoom included; 1 is native. Shown on device_pixel_ratio × css_width_px device pixels.
             */
            scale?: number | null;
            /** @description Width and height of the window's inside, CSS px. */
            viewport?: components["schemas"]["Length"][] | null;
        };
        /** @description Does the curve hold the data? */
        Goodness: {
            /**
             * Format: double
             * @description Twice the ln likelihood missed against a free share at each level.
             */
            deviance: number;
            /**
             * Format: int64
             * @description Levels − parameters; null when nothing is left over.
             */
            df?: number | null;
            /**
             * Format: double
             * @description P(χ² ≥ deviance): asymptotic.
             */
            p_asymptotic?: number | null;
            /**
             * Format: double
             * @description Share of simulated observers with at least this deviance.
             */
            p_simulated: number;
            /** @description How many were simulated. */
            simulations: number;
        };
        /** @description Cochran's Q of pairs within participants, with its p by permutation. */
        Heterogeneity: {
            /**
             * Format: double
             * @description Pairs less one.
             */
            df: number;
            /** @description Whether every way of dealing was counted. */
            exact: boolean;
            /**
             * Format: double
             * @description P(a Q at least as large) when each participant's choices are dealt out anew over the pairs they answered.
             */
            p: number;
            /**
             * Format: double
             * @description P(χ² ≥ Q), which holds for many participants.
             */
            p_asymptotic: number;
            /**
             * Format: double
             * @description The smallest p that so many random ways can give; null where p is exact.
             */
            p_smallest?: number | null;
            /**
             * Format: int64
             * @description Participants who chose the target in some pairs and not in others: nobody else tells pairs apart.
             */
            participants: number;
            /**
             * Format: double
             * @description Cochran's Q; where some participants left pairs out, the generalised Mantel–Haenszel statistic that it is a case of.
             */
            q: number;
        };
        /**
         * @description How the intraclass correlation is estimated.
         * @enum {string}
         */
        IccEstimator: "fleiss-cuzick" | "anova" | "beta-binomial";
        /** @description Why an input does not count. */
        Ignored: "untrusted" | "double" | "repeat" | "held" | "early" | "gap" | "answered";
        /** @description What an answer was given with. */
        Input: "mouse" | "touch" | "pen" | "keyboard";
        /** @description What the server found when it last looked at all that it stores. */
        IntegrityReport: {
            /** @description What is damaged and could not be mended, a sentence each; empty where all is well. */
            faults: string[];
        };
        /** @description A confidence (or credible) interval. */
        Interval: {
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description The probability with which it covers, in (0, 1).
             */
            level: number;
            /**
             * Format: double
             * @description Lower end.
             */
            low: number;
        };
        /** @description How long each step of a two-interval trial is asked to last, in ms. A page rounds each to whole frames of its display. */
        Intervals: {
            /**
             * Format: double
             * @description The first stimulus, 1 to 60000.
             */
            first_ms: number;
            /**
             * Format: double
             * @description A cross in the middle, 0 (none) to 10000.
             */
            fixation_ms: number;
            /**
             * Format: double
             * @description Noise in its place, 0 (none) to 10000.
             */
            mask_ms: number;
            /**
             * Format: double
             * @description The second stimulus, 1 to 60000.
             */
            second_ms: number;
        };
        /** @description How alike the choices of one participant are. */
        Intraclass: {
            /**
             * Format: double
             * @description Variance inflation 1 + (Σnᵢ²/Σnᵢ − 1)·icc of the pooled proportion; not below 0.
             */
            design_effect: number;
            /** @description Which estimator gave it. */
            estimator: components["schemas"]["IccEstimator"];
            /**
             * Format: double
             * @description Intraclass correlation, −1/(n − 1) to 1; 0 for independent trials.
             */
            icc: number;
            /**
             * Format: int64
             * @description Participants with at least one trial.
             */
            participants: number;
            /**
             * Format: double
             * @description The proportion of choices of the target under that estimator.
             */
            proportion: number;
            /**
             * Format: int64
             * @description Their trials.
             */
            trials: number;
        };
        /** @description One scene shown under both conditions of its block. */
        Item: {
            /** @description Identifier, unique in the study. */
            id: string;
            /**
             * Format: double
             * @description Where the pair lies on the axis of the block's psychometric function.
             */
            level?: number | null;
            /** @description Scene file relative to the study file; absent only where both conditions are picture files. */
            scene?: string | null;
        };
        /** @description One pair of a block. */
        ItemReport: {
            /** @description Item's id. */
            id: string;
            target?: components["schemas"]["Proportion"] | null;
        };
        /** @description How much likelier the data are under one hypothesis than under the other. */
        JzsBayesFactor: {
            /**
             * Format: double
             * @description 1 / bf10: evidence for no effect.
             */
            bf01: number;
            /**
             * Format: double
             * @description P(data | effect) / P(data | no effect); may overflow to infinity or underflow to 0 where `ln_bf10` does not.
             */
            bf10: number;
            /**
             * Format: double
             * @description ln bf10.
             */
            ln_bf10: number;
            /**
             * Format: double
             * @description Scale of the Cauchy prior on the standardised effect.
             */
            prior_scale: number;
        };
        /**
         * @description What is shown.
         * @enum {string}
         */
        Kind: "still" | "animation";
        /** @description What is known of the lapse rate λ. */
        Lapse: "prior" | {
            /**
             * Format: double
             * @description Known, in [0, 1 − guess).
             */
            fixed: number;
        };
        /** @description A participant who keeps to one side. */
        Leaning: {
            /**
             * Format: int64
             * @description Choices of what stood first.
             */
            first: number;
            /**
             * Format: double
             * @description Exact binomial p against a half.
             */
            p: number;
            /**
             * Format: double
             * @description The same corrected by Holm's method for all who were tested.
             */
            p_holm: number;
            /** @description Session's id. */
            session_id: string;
            /**
             * Format: int64
             * @description Choices.
             */
            trials: number;
        };
        /**
         * Format: double
         * @description A length that is not negative.
         */
        Length: number;
        /** @description The choices at one level. */
        LevelPoint: {
            /**
             * Format: double
             * @description The level.
             */
            level: number;
            target?: components["schemas"]["Proportion"] | null;
        };
        /** @description A link by which a study may be tried by who has it. */
        Link: {
            /**
             * Format: int64
             * @description When it ends, seconds since 1970.
             */
            expires_at_s: number;
            /** @description Path and query, below the server's address. */
            path: string;
        };
        /** @description What one value of a column means. */
        Meaning: {
            /** @description What it means; empty where the value says it. */
            meaning: string;
            /** @description The value. */
            value: string;
        };
        /** @description Participants' log odds scatter normally about the fixed effects: logit P = xβ + σz, z ~ N(0, 1) a participant. */
        MixedLogit: {
            /** @description The maximum is at σ = 0: participants differ no more than chance makes them. */
            boundary: boolean;
            /** @description For a participant at the centre (z = 0), in the order of the predictors; p and 95% interval from the normal. */
            coefficients: components["schemas"]["Coefficient"][];
            /**
             * Format: double
             * @description σ²/(σ² + π²/3): the intraclass correlation on the latent scale.
             */
            latent_icc: number;
            /**
             * Format: double
             * @description ln likelihood of the single choices (no binomial coefficients).
             */
            log_likelihood: number;
            /**
             * Format: double
             * @description The same with σ = 0.
             */
            log_likelihood_independent: number;
            /**
             * Format: int64
             * @description Participants with trials.
             */
            participants: number;
            /**
             * @description The model has as many parameters as the data have free proportions (intercept only, two trials each): it reproduces the mean
             *     and the second moment of the participants' proportions exactly, and nothing is left to test the normal shape.
             */
            saturated: boolean;
            /**
             * Format: double
             * @description Standard deviation σ of the participants' log odds.
             */
            sigma: number;
            /**
             * Format: double
             * @description P of the likelihood ratio under σ = 0, from ½χ²₀ + ½χ²₁ (σ is on its boundary there).
             */
            sigma_p: number;
            /**
             * Format: double
             * @description Its standard error; `None` on the boundary σ = 0.
             */
            sigma_standard_error?: number | null;
            /**
             * Format: int64
             * @description Their trials.
             */
            trials: number;
        };
        /**
         * @description How the proportion of choices follows from the difference of two conditions.
         * @enum {string}
         */
        Model: "thurstone" | "bradley-terry";
        /** @description A link that is asked for. */
        NewLink: {
            /**
             * Format: int32
             * @description For how many days it is good; 7 unless something else is said.
             */
            days?: number | null;
            /** @description What it is for. */
            visit: components["schemas"]["Trying"];
        };
        /** @description What is known of someone who begins. */
        NewSession: {
            /** @description What the browser says about its display; kept as it comes. `language` is the one in which the study is read. */
            display?: {
                [key: string]: unknown;
            } | null;
            kind?: components["schemas"]["SessionKind"] | null;
            /** @description The parameters of the address that they came by. The participant is named by the one that the study file says, or else by the first that is there of `PROLIFIC_PID`, `workerId`, `subject_id`, `id`; an id has at most 512 bytes and no control characters. */
            params?: {
                [key: string]: string;
            } | null;
        };
        /** @description One observer against the scale of the others. */
        ObserverFit: {
            /**
             * Format: int64
             * @description Their choices.
             */
            choices: number;
            /**
             * Format: double
             * @description How far below the first quartile of all observers' `log_likelihood`, in interquartile ranges; 0 above it (Perez-Ortiz & Mantiuk 2017).
             *     `None` also where that range is 0.
             */
            distance?: number | null;
            /** @description Who. */
            id: string;
            /**
             * Format: double
             * @description Mean ln likelihood of a choice on the others' scale; ln ½ = −0.693 for guessing. `None` when the observer has no choices or the
             *     others' comparisons fall apart.
             */
            log_likelihood?: number | null;
            /** @description `distance` > 1.5 (Tukey's fence), or z < −3 where there is no distance: look at this observer. Not a reason to exclude by itself; a preregistered rule is. */
            odd: boolean;
            /**
             * Format: double
             * @description The same, less its expectation, in standard deviations, if the observer chose as the others' scale says: far below −3 is odd.
             */
            z?: number | null;
        };
        /** @description What a one-sample (or paired) t-test says. */
        OneSampleTTest: {
            /**
             * Format: double
             * @description Degrees of freedom, n − 1.
             */
            df: number;
            /**
             * Format: double
             * @description Their mean (the mean difference), in the units of the values.
             */
            mean: number;
            /**
             * Format: double
             * @description The mean under the null hypothesis.
             */
            mu: number;
            /**
             * Format: int64
             * @description How many values (pairs).
             */
            n: number;
            /**
             * Format: double
             * @description Two-sided p-value, P(|T| ≥ |t|) under the null hypothesis; never 0 while it is above 5e-324.
             */
            p: number;
            /**
             * Format: double
             * @description Their standard deviation, n − 1 in the denominator.
             */
            sd: number;
            /**
             * Format: double
             * @description (mean − mu) / (sd / √n).
             */
            t: number;
        };
        /** @description What besides the conditions went with the choices. */
        OrderReport: {
            agreement?: components["schemas"]["WithinSlope"] | null;
            /** @description Block by block. */
            blocks: components["schemas"]["BlockOrder"][];
            first?: components["schemas"]["FirstTest"] | null;
            /** @description Participants with a side of their own: exact binomial test, p corrected by Holm for all who were tested. */
            leaning: components["schemas"]["Leaning"][];
            /**
             * Format: int64
             * @description The most trials any of them answered: with too few nobody's side can be shown.
             */
            most_trials: number;
            /**
             * Format: int64
             * @description Participants tested for a side of their own.
             */
            tested: number;
        };
        /** @description Where the scale has its zero. */
        Origin: "mean" | {
            /** @description The condition of this index. */
            condition: number;
        };
        /** @description Response times beyond Tukey's fences on the logarithm. */
        Outliers: {
            /**
             * Format: double
             * @description Answers above this time are slow outliers, in ms.
             */
            above_ms: number;
            /**
             * Format: int64
             * @description Answers with a time.
             */
            answers: number;
            /**
             * Format: double
             * @description Answers below this time are fast outliers, in ms.
             */
            below_ms: number;
            /**
             * Format: int64
             * @description Fast ones.
             */
            fast: number;
            /**
             * Format: int64
             * @description Slow ones.
             */
            slow: number;
        };
        /** @description The pairs of a block beside each other. */
        PairsReport: {
            model?: components["schemas"]["CrossedLogit"] | null;
            /** @description Why something is missing, and what the model cannot say. */
            notes: string[];
            test?: components["schemas"]["Heterogeneity"] | null;
        };
        /** @description A parameter of the curve. */
        Parameter: {
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description Lower end of the 95% posterior interval, each point's mass spread over its cell (psignifit 4.3 reads both ends half a cell lower).
             */
            low: number;
            /** @description Whether the data do not bound it: mass lies on the edge of the prior's range. */
            on_edge: boolean;
            /**
             * Format: double
             * @description Where the posterior density is highest.
             */
            value: number;
        };
        /** @description How many people take part in one version of a study. */
        Participants: {
            /**
             * Format: int64
             * @description Finished.
             */
            completed: number;
            /**
             * Format: int64
             * @description Not finished, and seen within the idle time.
             */
            in_progress: number;
            /**
             * Format: int64
             * @description Sessions ever begun.
             */
            started: number;
        };
        /** @description Picture files of one item: paths relative to the study file. */
        Pictures: string | string[];
        /** @description Something in a section. */
        Piece: {
            /** @description A heading below the section's. */
            content: string;
            /** @enum {string} */
            kind: "heading";
        } | {
            /** @description A paragraph. */
            content: string;
            /** @enum {string} */
            kind: "text";
        } | {
            /** @description Something that nobody must overlook. */
            content: string;
            /** @enum {string} */
            kind: "warning";
        } | {
            /** @description Sentences of equal rank. */
            content: string[];
            /** @enum {string} */
            kind: "list";
        } | {
            /** @description Rows and columns. */
            content: components["schemas"]["Table"];
            /** @enum {string} */
            kind: "table";
        } | {
            /** @description A picture. */
            content: components["schemas"]["Figure"];
            /** @enum {string} */
            kind: "figure";
        };
        /**
         * Format: int32
         * @description A length in whole pixels.
         */
        Pixels: number;
        /** @description A version of a study and what it has gathered. */
        PooledVersion: {
            /**
             * Format: int64
             * @description Answers to it.
             */
            answers: number;
            /**
             * Format: int64
             * @description Sessions begun with it.
             */
            sessions: number;
            /** @description SHA-256 of its design and of the pixels that it shows. */
            version: string;
        };
        /** @description The primary endpoint: which test of what decides, and after how many participants. */
        PrimaryEndpoint: {
            /** @description The block that is tested; absent for a difference on the scale. */
            block?: string | null;
            /** @description The two conditions whose difference on the scale is tested. */
            compare?: string[] | null;
            /** @description The item of the block that is tested alone. */
            item?: string | null;
            /**
             * Format: int32
             * @description Participants who are to be judged when the result is first looked at; absent: the file does not say.
             */
            participants?: number | null;
            /** @description The test that decides, at a level of 0.05 and uncorrected, as it is one. */
            test: components["schemas"]["PrimaryTest"];
        };
        /** @description The primary endpoint judged: one test, so that its p is not corrected for others. */
        PrimaryReport: {
            /** @description Whether it decides: p below 0.05. */
            found: boolean;
            /** @description What was named. */
            named: components["schemas"]["PrimaryEndpoint"];
            /** @description What is tested, in words. */
            of: string;
            /**
             * Format: double
             * @description Its p; null where the test is not defined.
             */
            p?: number | null;
            /**
             * Format: double
             * @description The smallest p that random patterns of signs can give; null for a p that is computed.
             */
            p_smallest?: number | null;
            /**
             * Format: int64
             * @description Participants who are judged in it.
             */
            participants: number;
        };
        /**
         * @description A test that can decide.
         * @enum {string}
         */
        PrimaryTest: "t-test" | "sign" | "wilcoxon" | "equivalence" | "binomial" | "scale";
        /** @description What the paper prints about one comparison, to three decimals. */
        Printed: {
            /**
             * Format: double
             * @description Mean number of PA images chosen.
             */
            mean: number;
            /**
             * Format: double
             * @description Standard deviation.
             */
            sd: number;
            /**
             * Format: double
             * @description t.
             */
            t: number;
        };
        /** @description Whether the printed t of the third comparison can come from any data. */
        PrintedT: {
            /** @description The split whose t comes closest. */
            closest: components["schemas"]["Split"];
            /** @description The numbers of participants that were tried, from and to. */
            participants: [
                number,
                number
            ];
            /** @description Numbers of participants at which the printed mean and sd, anywhere within their rounding, allow it. */
            participants_with_this_t: number[];
            /**
             * Format: double
             * @description The t in question.
             */
            printed: number;
            /** @description Splits that round to the printed mean and sd. */
            splits_with_this_summary: components["schemas"]["Split"][];
            /** @description Splits of that many participants whose t rounds to it. */
            splits_with_this_t: components["schemas"]["Split"][];
        };
        /** @description An answer that says what is wrong (RFC 9457). */
        Problem: {
            /** @description What kind of problem it is. */
            code: components["schemas"]["ProblemCode"];
            /** @description What happened, for people. */
            detail: string;
            /** @description The fields or parameters that are wrong, all of them up to a hundred. */
            errors?: components["schemas"]["FieldError"][];
            /** @description With `incomplete`: indices of the decided trials that have no answer yet. */
            missing?: number[];
            /** @description With `incomplete`: whether more trials are to be decided. */
            more?: boolean;
            /**
             * Format: int32
             * @description The HTTP status.
             */
            status: number;
            /** @description With `already_answered`: what is stored. */
            stored?: components["schemas"]["StoredAnswer"];
            /** @description The status in words. */
            title: string;
            /** @description Always `about:blank`: `code` tells the kinds apart. */
            type: string;
        };
        /** @description What kind of problem it is. */
        ProblemCode: "bad_body" | "bad_json" | "invalid_parameter" | "ambiguous_version" | "unauthorized" | "wrong_password" | "cross_site" | "link_refused" | "not_found" | "method_not_allowed" | "no_consent" | "already_answered" | "plan_changed" | "already_begun" | "already_finished" | "incomplete" | "too_large" | "not_json" | "invalid_field" | "internal" | "unavailable" | "not_ready" | "stimuli_failed";
        /** @description How far the stimuli are. */
        Progress: {
            /** @description Stimuli that are ready. */
            done: number;
            /** @description What is being made now. */
            stimulus: string;
            /** @description Stimuli in all. */
            total: number;
        };
        /** @description A share of choices. */
        Proportion: {
            by_participant?: components["schemas"]["ShareInterval"] | null;
            /**
             * Format: int64
             * @description Choices of the target.
             */
            chosen: number;
            /** @description Why they give none. */
            note?: string | null;
            /**
             * Format: int64
             * @description Participants who made them.
             */
            participants: number;
            /**
             * Format: double
             * @description chosen / trials.
             */
            proportion: number;
            /**
             * Format: int64
             * @description Choices made.
             */
            trials: number;
            /** @description Wilson's interval, which takes the choices as independent: right where each participant made one. */
            wilson: components["schemas"]["Interval"];
        };
        /**
         * @description A psychometric function of a block: how the share of target choices depends on the pairs' level. With two pictures to choose from,
         *     the guess rate is ½.
         */
        Psychometric: {
            /** @description Whether the share of target choices grows or falls with the level. */
            direction: components["schemas"]["Direction"];
            /** @description Its shape. */
            function: components["schemas"]["Sigmoid"];
            /** @description What the level is, such as `triangles`. */
            label: string;
            /** @description What is known of the lapse rate. */
            lapse: components["schemas"]["Lapse"];
            /** @description Whether the t-test of the block's counts is planned too, beside its thresholds. */
            t_test?: boolean;
            /** @description Shares of target choices, between ½ and 1, whose levels are wanted. */
            thresholds: number[];
            /** @description Its unit, such as `log10` or `mm`; absent: none. */
            unit?: string | null;
        };
        /** @description A fitted psychometric function. */
        PsychometricFit: {
            /** @description Levels at the shares asked for. */
            at: components["schemas"]["ThresholdAt"][];
            /** @description Points of the curve where the posterior is highest, from a little below the lowest level to a little above the highest. */
            curve: components["schemas"]["CurvePoint"][];
            /** @description Overdispersion η: η² is the correlation of two answers at one level; 0 is binomial. */
            eta: components["schemas"]["Parameter"];
            goodness?: components["schemas"]["Goodness"] | null;
            /** @description Lapse rate. */
            lapse: components["schemas"]["Parameter"];
            /** @description Level at which the curve is halfway between guessing and lapsing (F = ½, unscaled), where the posterior is highest. */
            threshold: components["schemas"]["Parameter"];
            threshold_by_participant?: components["schemas"]["ResampledThreshold"] | null;
            /** @description From F = .05 to F = .95, in levels. */
            width: components["schemas"]["Parameter"];
        };
        /** @description A block's psychometric function with its data, everything in the levels of the study file. */
        PsychometricReport: {
            /** @description What was asked for: shape, direction, label and unit of the level. */
            asked: components["schemas"]["Psychometric"];
            fit?: components["schemas"]["PsychometricFit"] | null;
            /**
             * Format: double
             * @description Guess rate, given by the task: ½ with two pictures.
             */
            guess: number;
            /** @description Why there is no curve, or what a reader must not conclude from it. */
            notes: string[];
            /** @description Target choices at each level, levels rising. */
            points: components["schemas"]["LevelPoint"][];
        };
        /** @description Quartiles by linear interpolation between order statistics (R's type 7). */
        Quartiles: {
            /**
             * Format: double
             * @description Median.
             */
            median: number;
            /**
             * Format: int64
             * @description Number of values.
             */
            n: number;
            /**
             * Format: double
             * @description First quartile.
             */
            q1: number;
            /**
             * Format: double
             * @description Third quartile.
             */
            q3: number;
        };
        /**
         * @description How a p-value was found.
         * @enum {string}
         */
        RankMethod: "exact" | "normal";
        /**
         * @description What happens when somebody comes whose id has a session in this study already.
         * @enum {string}
         */
        Repeat: "flag" | "resume" | "refuse";
        /** @description A session of a person whose answers are counted already. */
        Repeated: {
            /** @description The person's session that counts: the first complete one, or the first with answers where none is complete. */
            counted: string;
            /** @description Session's id. */
            session_id: string;
        };
        /** @description The whole replication. */
        Replication: {
            /** @description The three comparisons in the paper's order. */
            comparisons: components["schemas"]["Comparison"][];
            /** @description About the third t. */
            printed_t: components["schemas"]["PrintedT"];
        };
        /** @description A study judged. */
        Report: {
            /** @description Each block, in study order. */
            blocks: components["schemas"]["BlockReport"][];
            consistency?: components["schemas"]["Consistency"] | null;
            /** @description How the numbers that are there were got, paragraph by paragraph, as a methods section says it. */
            methods: string[];
            order?: components["schemas"]["OrderReport"] | null;
            primary?: components["schemas"]["PrimaryReport"] | null;
            /** @description What to cite for the methods that were used, in order of appearance. */
            references: string[];
            scale?: components["schemas"]["ScaleIntervals"] | null;
            /** @description Why there is no scale. */
            scale_note?: string | null;
            /** @description What was shown in the choices that a scale takes together. */
            scale_pools: string;
        };
        /** @description A threshold's interval from resampled participants. */
        ResampledThreshold: components["schemas"]["Bootstrap"] & {
            /**
             * @description Resamples whose threshold or width ended on the edge of the range that is searched, or whose threshold could be any number: their
             *     participants did not show the curve, and the interval may be wider than it is here.
             */
            at_bound: number;
        };
        /** @description When an input counts as the response to a trial. What does not count is logged with its time. */
        ResponseRules: {
            /**
             * Format: double
             * @description How long after the last input that counted, in ms, 0 to 60000.
             */
            min_gap_ms?: number | null;
            /**
             * Format: double
             * @description How long the stimulus must have been visible, in ms, 0 to 60000.
             */
            min_visible_ms?: number | null;
        };
        /** @description A logistic regression whose standard errors allow any dependence within participants. */
        RobustLogit: {
            /** @description In the order of the predictors; p and interval from t with `df`. */
            coefficients: components["schemas"]["Coefficient"][];
            /** @description Which small-sample factor. */
            correction: components["schemas"]["Correction"];
            /**
             * Format: double
             * @description Participants − 1.
             */
            df: number;
            /**
             * Format: double
             * @description ln likelihood of the single choices (no binomial coefficients).
             */
            log_likelihood: number;
            /** @description Standard errors that wrongly take the trials as independent, for comparison. */
            naive_standard_errors: number[];
            /**
             * Format: int64
             * @description Participants with trials.
             */
            participants: number;
            /**
             * Format: int64
             * @description Their trials.
             */
            trials: number;
        };
        /** @description The place that a stimulus has in its trial. */
        Role: "left" | "right" | "first" | "second";
        /** @description Positions of conditions on one axis. */
        Scale: {
            /**
             * Format: int64
             * @description Choices.
             */
            choices: number;
            /** @description The conditions' names. */
            conditions: string[];
            /** @description Covariance of `jod`, n × n, JOD² (rank n − 1). */
            covariance: number[][];
            /**
             * Format: double
             * @description −2 ln of the likelihood ratio to a model with a free proportion for each compared pair.
             */
            deviance: number;
            /**
             * Format: int64
             * @description Compared pairs − (conditions − 1).
             */
            deviance_df: number;
            /**
             * Format: double
             * @description P(χ² ≥ deviance): small when one dimension does not hold the data. Asymptotic; meaningless below about 5 expected choices a cell.
             */
            deviance_p: number;
            /** @description What was maximised: `maximum-likelihood` or `jeffreys`, never `automatic`. */
            estimator: components["schemas"]["Estimator"];
            /** @description Their positions, in JOD; more is chosen more often. */
            jod: number[];
            /**
             * Format: double
             * @description ln likelihood of the single choices (no binomial coefficients, no prior).
             */
            log_likelihood: number;
            /** @description Gaussian or logistic. */
            model: components["schemas"]["Model"];
            /** @description The scale's zero. */
            origin: components["schemas"]["Origin"];
            /**
             * @description Standard errors in JOD, from the inverse information (observed; expected under Jeffreys' prior): right only for independent choices. Observers differ, so report
             *     [`observer_intervals`](super::observer_intervals).
             */
            standard_errors: number[];
        };
        /** @description A scale with what its observers' differences do to it. */
        ScaleIntervals: {
            /** @description One interval a condition, in the scale's order. */
            conditions: components["schemas"]["ConditionInterval"][];
            /** @description One interval a pair of conditions: read significance here, not from overlaps above. */
            differences: components["schemas"]["DifferenceInterval"][];
            /** @description Random patterns of signs behind each p that is not exact. */
            flips: number;
            /**
             * Format: double
             * @description Confidence level.
             */
            level: number;
            /** @description Why an interval is missing; null where none is. */
            note?: string | null;
            /** @description Observers with choices. */
            observers: number;
            /** @description The scale of all observers. */
            scale: components["schemas"]["Scale"];
            /**
             * Format: int64
             * @description The seed that repeats them.
             */
            seed: number;
        };
        /** @description Whose answers are set aside, decided before there are any. */
        Screening: {
            /** @description What excludes the participant where it was noticed of the session. */
            flags?: components["schemas"]["Flag"][];
            /** @description Whether not finishing excludes the participant. */
            incomplete: boolean;
            /**
             * Format: int32
             * @description More wrong answers in catch blocks than this exclude the participant; absent: none does.
             */
            max_failed_catch_trials?: number | null;
            /**
             * Format: int32
             * @description More too-fast trials than this exclude the participant.
             */
            max_fast_trials: number;
            /**
             * Format: double
             * @description A trial answered faster than this counts as too fast, in ms; absent: none does.
             */
            min_rt_ms?: number | null;
            /** @description Whether choosing the same side in every one of at least five trials excludes the participant. */
            straight_lining: boolean;
        };
        /** @description A part with a heading. */
        Section: {
            /** @description What stands in it. */
            pieces: components["schemas"]["Piece"][];
            /** @description For the page and the paper, not for the terminal. */
            reference: boolean;
            /** @description Its heading. */
            title: string;
        };
        /** @description When a version of a study was served. */
        Served: {
            /** @description For the first time, ISO-8601 UTC. */
            first: string;
            /** @description For the last time. */
            last: string;
        };
        /** @description Whose a session is. The analysis is of participants alone. */
        SessionKind: "participant" | "pilot" | "simulated";
        /** @description Whose visit is whose. */
        SessionRules: {
            /** @description The parameter of the participant's link that names the participant; absent: the first that is there of those that panels use. */
            id?: string | null;
            /** @description Parameters of the participant's link that stand in the table of participants, besides the one that names the participant. */
            params?: string[];
            /** @description Whether each visit is somebody else's, as on a laboratory's computer: nothing is resumed without being asked for. */
            per_visit?: boolean;
            /** @description What happens to an id that comes again. */
            repeat?: components["schemas"]["Repeat"];
        };
        /** @description Where a session stands. */
        SessionState: {
            /** @description The code at the end, once completed. */
            completion_code?: string;
            /** @description Whether consent has been given. */
            consented: boolean;
            /** @description The language in which it is taken: the `language` of the display that it began with where the study has it, else the study's own. */
            language: string;
            /** @description Whether more trials will be decided, from the answers to these. */
            more: boolean;
            /** @description Most trials there can be. */
            most_trials: number;
            /** @description Whether the link named the participant: who comes by it again is the same person. */
            named: boolean;
            /**
             * Format: int32
             * @description The first decided trial without an answer; null when there is none.
             */
            next_trial: number | null;
            /** @description Which plan these are of: the session has another one where it was decided anew. Absent in a preview, whose plan stays. */
            plan?: string;
            /** @description Where to go on to, once completed, if the study leads anywhere. */
            redirect?: string;
            /** @description Its id (UUID v7). */
            session_id: string;
            /** @description How far it is. */
            status: components["schemas"]["SessionStatus"];
            /** @description The study as it was when the session began: its texts and its question stay the session's own. */
            study: components["schemas"]["Study"];
            /** @description The study's id. */
            study_id: string;
            /** @description The trials that are decided so far, by index from 0. The list of a plan only grows. */
            trials: components["schemas"]["Trial"][];
        };
        /** @description How far a session is. */
        SessionStatus: "consent" | "in_progress" | "completed";
        /** @description Whether a share is equivalent to one half. */
        ShareEquivalence: {
            /** @description The tests, in choices of one participant. */
            tests: components["schemas"]["Equivalence"];
            /**
             * Format: double
             * @description The bound: how far from ½ the share may lie.
             */
            within: number;
        };
        /** @description A share's interval over participants. */
        ShareInterval: {
            /**
             * Format: double
             * @description How many independent choices it takes the choices to be worth; never more than there are.
             */
            effective_trials: number;
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description Confidence level.
             */
            level: number;
            /**
             * Format: double
             * @description Lower end.
             */
            low: number;
            /** @description How it was found. */
            method: components["schemas"]["ShareMethod"];
        };
        /**
         * @description How a share's interval was found.
         * @enum {string}
         */
        ShareMethod: "wilson" | "clustered-wilson" | "clopper-pearson";
        /** @description How often stimuli were shown at a size, and how large that was on participants' displays. */
        ShownAt: {
            /**
             * Format: int64
             * @description Answers given to stimuli of this size, of those who are judged.
             */
            answers: number;
            /** @description Least and greatest width, CSS px; null where no page said so. */
            css_width_px?: number[] | null;
            /** @description Least and greatest device pixels a stimulus pixel, 1 being native; null where no page said so. */
            scale?: number[] | null;
            /** @description [width, height] in the stimuli's own pixels; [0, 0] where that was never known. */
            size: number[];
        };
        /** @description One of the two pictures. */
        Side: "left" | "right";
        /**
         * @description The shape of the curve F between guessing and lapsing.
         * @enum {string}
         */
        Sigmoid: "gaussian" | "logistic" | "weibull";
        /** @description What signs a researcher in. */
        SignIn: {
            /**
             * Format: password
             * @description The researcher's password, as in the data folder's `researcher-password`.
             */
            password: string;
        };
        /** @description Who is signed in. */
        SignedIn: {
            /** @description The researcher's name. */
            name: string;
        };
        /** @description What Wilcoxon's signed-rank test says. */
        SignedRank: {
            /** @description How it was found. */
            method: components["schemas"]["RankMethod"];
            /**
             * Format: int64
             * @description Values that differ from mu; the others are left out, as Wilcoxon did.
             */
            n: number;
            /**
             * Format: double
             * @description Two-sided p: twice the smaller tail, at most 1.
             */
            p: number;
            /**
             * Format: double
             * @description Sum of the (mid)ranks of the values above mu.
             */
            v: number;
        };
        /** @description What a trial shows at one size. */
        SizedStimuli: {
            /**
             * Format: int32
             * @description Height in pixels.
             */
            height: number;
            /** @description What is shown, by role. */
            shown: {
                [key: string]: components["schemas"]["StimulusRef"];
            };
            /**
             * Format: int32
             * @description Width in pixels.
             */
            width: number;
        };
        /** @description A split of binary answers and its t. */
        Split: {
            /**
             * Format: int64
             * @description Of whom so many chose PA.
             */
            chosen: number;
            /**
             * Format: int64
             * @description Participants.
             */
            n: number;
            /**
             * Format: double
             * @description t against ½.
             */
            t: number;
        };
        /** @description Who is judged, and who is not. */
        Standing: {
            /** @description How even the design came out. */
            balance: components["schemas"]["Balance"];
            /** @description The same in words; empty without answers. */
            balance_summary: string;
            /** @description What was noticed of sessions, whether or not it leaves them out. */
            flagged: components["schemas"]["Flagged"][];
            /**
             * Format: int64
             * @description Participants whose answers are judged.
             */
            judged: number;
            /**
             * Format: int64
             * @description Trial runs of researchers, left out.
             */
            pilots: number;
            /** @description Sessions of persons whose first complete session counts. */
            repeated: components["schemas"]["Repeated"][];
            /**
             * Format: int64
             * @description Sessions of simulations, left out.
             */
            simulated: number;
            /** @description The numbers in a sentence. */
            summary: string;
            /**
             * Format: int64
             * @description Participants in progress who are judged only once they finish.
             */
            unfinished: number;
            /** @description Kinds of sessions that are judged like participants', because somebody asked for it. */
            with: components["schemas"]["SessionKind"][];
        };
        /** @description A number of whole frames for each step of the trial. */
        StepFrames: {
            /**
             * Format: int32
             * @description The first stimulus.
             */
            first: number;
            /**
             * Format: int32
             * @description The fixation cross.
             */
            fixation: number;
            /**
             * Format: int32
             * @description The mask between.
             */
            mask: number;
            /**
             * Format: int32
             * @description The second stimulus.
             */
            second: number;
        };
        /** @description A duration for each step of the trial, in ms. */
        StepTimes: {
            /**
             * Format: double
             * @description The first stimulus.
             */
            first: number;
            /**
             * Format: double
             * @description The fixation cross.
             */
            fixation: number;
            /**
             * Format: double
             * @description The mask between.
             */
            mask: number;
            /**
             * Format: double
             * @description The second stimulus.
             */
            second: number;
        };
        /** @description What one item of a study shows under one condition. */
        Stimulus: {
            /** @description Condition's name. */
            condition: string;
            /** @description Item's id. */
            item: string;
            /** @description Hash of its decoded pixels. */
            pixels_sha256: string;
            /** @description How it was made, with its measured error. */
            provenance: unknown;
            /** @description Hash of the stimulus's file. */
            sha256: string;
            /** @description [width, height] in pixels; [0, 0] where that was never known. */
            size: number[];
        };
        /**
         * @description The bytes of one stimulus as this session gets them: what they hash to and where they are. Other sessions get other bytes and
         *     addresses for the same picture.
         */
        StimulusRef: {
            /** @description SHA-256 of the bytes. */
            sha256: string;
            /** @description Their address on this server; who knows it may have them. */
            url: string;
        };
        /** @description An answer as it is stored. */
        StoredAnswer: {
            /** @description What analyses read of it; null once it was blanked by a withdrawal. */
            answer: {
                [key: string]: unknown;
            } | null;
            /** @description All that the browser sent; null once it was blanked by a withdrawal. */
            payload: {
                [key: string]: unknown;
            } | null;
            /** @description When the server committed it, ISO-8601 UTC. */
            received_at: string;
        };
        /** @description What a study says of itself before anybody takes part. */
        Study: {
            /** @description In which sizes stimuli are made and shown. */
            display: components["schemas"]["Display"];
            /**
             * Format: int32
             * @description How long taking part is said to take, in minutes.
             */
            estimated_minutes: number;
            /** @description Its id, as in addresses. */
            id: string;
            /** @description The language of title, question and texts (BCP 47). */
            language: string;
            /** @description Whether each visit is somebody else's, as on a laboratory's computer. */
            per_visit: boolean;
            /** @description The question over every trial. */
            question: string;
            /** @description When an input counts as a response. */
            response: components["schemas"]["ResponseRules"];
            /** @description Stimulus size [width, height] in pixels; the smallest where there are several. */
            size: number[];
            /**
             * Format: double
             * @description Linear luminance of the grey around the stimuli, 0 to 1.
             */
            surround: number;
            /** @description What participants read. */
            texts: components["schemas"]["Texts"];
            /** @description Title. */
            title: string;
            /** @description The same in other languages, by tag. */
            translations: {
                [key: string]: components["schemas"]["Translation"];
            };
            /** @description Kinds of trial, in the order of first use. */
            trial_kinds: components["schemas"]["TrialName"][];
        };
        /** @description A study as its file defines it; every value has been checked. */
        StudyDefinition: {
            /** @description Blocks in the order they are shown. */
            blocks: components["schemas"]["Block"][];
            /** @description The code at the end and where it leads. */
            completion: components["schemas"]["CompletionSettings"];
            /** @description How stimuli come to be, by condition name. */
            conditions: {
                [key: string]: components["schemas"]["Condition"];
            };
            /** @description In which sizes stimuli are made and shown, as far as the file says so. */
            display?: components["schemas"]["DisplayRules"];
            /**
             * Format: int32
             * @description Whose defaults the file has; files without one have the first's.
             */
            edition?: number;
            equivalence?: components["schemas"]["EquivalenceBound"] | null;
            /**
             * Format: int32
             * @description How long taking part is said to take, in minutes.
             */
            estimated_minutes: number;
            /** @description The file's name without `.toml`; stands in addresses and data. */
            id: string;
            /**
             * Format: int32
             * @description A session without a sign of life for this long gives its slot to someone else, in minutes.
             */
            idle_minutes: number;
            /** @description The language of its texts, as a BCP 47 tag. */
            language?: string;
            primary?: components["schemas"]["PrimaryEndpoint"] | null;
            /** @description The question over every pair. */
            question: string;
            /** @description When an input counts as a response, as far as the file says so. */
            response?: components["schemas"]["ResponseRules"];
            /** @description Rules of exclusion, stated before there are results. */
            screening?: components["schemas"]["Screening"];
            /**
             * Format: int64
             * @description Seed of every participant's trial plan, 0..=2^53.
             */
            seed: number;
            /** @description Whose visit is whose. */
            session?: components["schemas"]["SessionRules"];
            /** @description Stimulus size [width, height] in pixels; the smallest where there are several. */
            size: number[];
            /**
             * Format: double
             * @description Linear luminance of the grey around the stimuli, 0..=1.
             */
            surround: number;
            /** @description What participants read. */
            texts: components["schemas"]["Texts"];
            /** @description Title for participants and researchers. */
            title: string;
            /** @description What participants read in other languages, by tag. */
            translations?: {
                [key: string]: components["schemas"]["Translation"];
            };
        };
        /** @description One page of the studies. */
        StudyList: {
            /** @description The studies on it. */
            items: components["schemas"]["StudySummary"][];
            /** @description What to ask with for the next page; null on the last one. */
            next_cursor: string | null;
        };
        /** @description Everything kelir can say of one version of a study, as a report or a paper's methods and results need it. */
        StudyReport: components["schemas"]["Report"] & {
            /** @description When the first and the last answer came, ISO-8601 UTC; null without answers. */
            answered?: string[] | null;
            /** @description The blocks with everybody; null when nobody is excluded. */
            blocks_with_excluded?: components["schemas"]["BlockReport"][] | null;
            /** @description Whether the stored answers are what was written: the study's own chain and, before it, the one that all studies used to share. */
            chain: components["schemas"]["Chain"];
            /** @description The study's definition, every value of it. */
            design: components["schemas"]["StudyDefinition"];
            /** @description With which devices those who are judged took part, counted. */
            devices: components["schemas"]["DeviceCount"][];
            /** @description What the pooled versions do not show alike. */
            different_stimuli: components["schemas"]["DifferentStimulus"][];
            /** @description Who is left out by the study's rules of screening, and why. */
            excluded: components["schemas"]["Excluded"][];
            /** @description Version of kelir that judged. */
            kelir_version: string;
            /** @description Other versions of the study that have sessions; their answers are not in here. */
            other_versions: components["schemas"]["PooledVersion"][];
            paper?: components["schemas"]["Replication"] | null;
            /** @description How many people take part. */
            participants: components["schemas"]["Participants"];
            /** @description The versions whose answers are in here, the one above first: others only where somebody named them. */
            pooled: components["schemas"]["PooledVersion"][];
            /** @description The question over every pair. */
            question: string;
            scale_with_excluded?: components["schemas"]["ScaleIntervals"] | null;
            /** @description The study's rules of screening. */
            screening: components["schemas"]["Screening"];
            served?: components["schemas"]["Served"] | null;
            /** @description In which sizes it was shown, by rising size. */
            shown: components["schemas"]["ShownAt"][];
            /** @description Who is judged, and who is not. */
            standing: components["schemas"]["Standing"];
            /** @description What was shown, with how it was made and its measured error. */
            stimuli: components["schemas"]["Stimulus"][];
            /** @description Study's id. */
            study: string;
            /** @description Study's title. */
            title: string;
            /** @description Version of the study that this is of: SHA-256 of its design and of the pixels that it shows. */
            version: string;
        };
        /** @description Results of one version of a study, or of several pooled by name. */
        StudyResults: {
            /** @description The paper's test for each block, without the excluded. */
            blocks: components["schemas"]["BlockSummary"][];
            /** @description The same with everybody; null when nobody is excluded. */
            blocks_with_excluded?: components["schemas"]["BlockSummary"][] | null;
            /** @description What the pooled versions do not show alike. */
            different_stimuli: components["schemas"]["DifferentStimulus"][];
            /** @description In which size whom a stimulus is shown, in words. */
            display: string;
            /** @description What a participant downloads at each of the sizes; empty where some stimuli are not packed. */
            downloads: components["schemas"]["Download"][];
            /** @description Who is left out by the study's rules of screening, and why. */
            excluded: components["schemas"]["Excluded"][];
            /** @description Other versions of the study that have sessions; their answers are not in these results. */
            other_versions: components["schemas"]["PooledVersion"][];
            /** @description How many people take part. */
            participants: components["schemas"]["Participants"];
            /** @description The versions whose answers are in, the one above first. */
            pooled: components["schemas"]["PooledVersion"][];
            scale?: components["schemas"]["Scale"] | null;
            /** @description Why there is no scale. */
            scale_note?: string | null;
            /** @description Who is judged, and who is not. */
            standing: components["schemas"]["Standing"];
            /** @description What was shown, with how it was made and its measured error. */
            stimuli: components["schemas"]["Stimulus"][];
            /** @description Study's id. */
            study: string;
            /** @description Study's title. */
            title: string;
            /** @description Version of the study that these results are of. */
            version: string;
        };
        /** @description Whether participants can come. */
        StudyStatus: "ready" | "preparing" | "failed";
        /** @description A study as the researchers' list has it. */
        StudySummary: {
            /** @description SHA-256 of what the study file says. */
            file_hash: string;
            /** @description Its id, as in addresses. */
            id: string;
            /** @description Most trials that a participant sees. */
            most_trials: number;
            /** @description How many people take part in the version that is served. */
            participants: components["schemas"]["Participants"];
            progress: components["schemas"]["Progress"] | null;
            /** @description Of a study that failed: why. */
            reason: string | null;
            /** @description Whether participants can come. */
            status: components["schemas"]["StudyStatus"];
            /** @description Title. */
            title: string;
            /** @description The version that is served; null while its stimuli are not all made. */
            version: string | null;
            /** @description What may be a mistake in its file, and is served all the same. */
            warnings: string[];
        };
        /** @description A version of a study: what was asked and what was shown. */
        StudyVersion: {
            /**
             * Format: int64
             * @description Answers to it.
             */
            answers: number;
            /** @description Hash of its definition alone. */
            design_hash: string;
            /** @description When it was first served, ISO-8601 UTC. */
            first_served_at: string;
            /** @description Whether it is the one that is served. */
            is_current: boolean;
            /** @description When it was last loaded to be served, ISO-8601 UTC. */
            last_served_at: string;
            /** @description How many people took part in it. */
            participants: components["schemas"]["Participants"];
            /** @description Stimuli that it shows. */
            stimuli: number;
            /** @description Title at the time. */
            title: string;
            /** @description Its hash. */
            version: string;
        };
        /** @description A one-sample or paired t-test that is planned. */
        TPlan: {
            /**
             * Format: double
             * @description Level of the two-sided test.
             */
            alpha: number;
            /**
             * Format: double
             * @description The true effect in standard deviations.
             */
            d: number;
            /**
             * Format: int64
             * @description Participants (pairs).
             */
            n: number;
            /**
             * Format: double
             * @description Probability that the test rejects, in either direction.
             */
            power: number;
        };
        /** @description A two-tailed one-sample t-test of a table of counts; a number that is not defined is `None` and the note says why. */
        TTest: {
            /**
             * Format: double
             * @description n − 1.
             */
            df?: number | null;
            /**
             * Format: double
             * @description Their mean.
             */
            mean?: number | null;
            /**
             * Format: int64
             * @description Observations.
             */
            n: number;
            /** @description Why a number is missing. */
            note?: string | null;
            /**
             * Format: double
             * @description Two-sided p.
             */
            p?: number | null;
            /**
             * Format: double
             * @description Sample standard deviation (n − 1).
             */
            sd?: number | null;
            /**
             * Format: double
             * @description (mean − mu) / (sd / √n).
             */
            t?: number | null;
        };
        /** @description Rows and columns. */
        Table: {
            /** @description What it holds. */
            caption: string;
            /** @description Heads of the columns. */
            columns: components["schemas"]["TableColumn"][];
            /** @description From the top down. */
            rows: components["schemas"]["TableRow"][];
        };
        /** @description A place in a table. */
        TableCell: {
            /** @description The numbers behind it in full precision, space-separated; null where it is no number. */
            exact?: string | null;
            /** @description In smaller letters below; null for nothing. */
            note?: string | null;
            /** @description What is read. */
            shown: string;
        };
        /** @description The head of a column. */
        TableColumn: {
            /** @description What stands in it, with its unit. */
            name: string;
            /** @description Whether it holds numbers, set to the right. */
            numeric: boolean;
        };
        /** @description A line of a table. */
        TableRow: {
            /** @description A name for the rows that follow. */
            content: string;
            /** @enum {string} */
            kind: "group";
        } | {
            /** @description One cell a column. */
            content: components["schemas"]["TableCell"][];
            /** @enum {string} */
            kind: "cells";
        };
        /** @description What every page says of how a trial was taken. A stimulus pixel is one of the picture, a device pixel one of the display, a CSS pixel one of the page. */
        Taken: components["schemas"]["Geometry"] & {
            at_onset?: components["schemas"]["Geometry"] | null;
            /** @description What happened to the page from the last answer to this one; the table of events has a row each. */
            events?: components["schemas"]["TrialEvent"][] | null;
            /**
             * Format: int32
             * @description How many events there were beyond those that are listed.
             */
            events_dropped?: number | null;
            /** @description Of animations: how each was played, by role. */
            frames?: {
                [key: string]: components["schemas"]["FrameLog"];
            } | null;
            /**
             * Format: int32
             * @description 1 where they stood otherwise at onset, else 0; the changes are events.
             */
            geometry_changed?: number | null;
            /**
             * Format: double
             * @description How long the page was hidden during the trial.
             */
            hidden_ms?: number | null;
            input?: components["schemas"]["Input"] | null;
            /**
             * Format: double
             * @description The shortest time for which any of the trial's stimuli was in view before the answer.
             */
            min_visible_ms?: number | null;
            /**
             * Format: int32
             * @description Of animations: how many of their frames were never drawn, or later than their time by more than a refresh. More than 0 marks a trial.
             */
            missed_frames?: number | null;
            /**
             * Format: double
             * @description When that frame was shown, by the page's own clock.
             */
            onset?: number | null;
            /** @description Version of that plugin. */
            plugin_version?: string | null;
            /**
             * Format: double
             * @description Measured refresh rate of the display; empty where it could not be measured.
             */
            refresh_hz?: number | null;
            /**
             * Format: int32
             * @description How often the page had been reloaded.
             */
            reload_count?: number | null;
            /**
             * Format: double
             * @description From the first frame at which an answer was possible (the stimuli in view, or the question after two intervals) to the answer.
             */
            rt: number;
            /** @description Width and height of the size at which the stimuli were shown, in their own pixels: one of the study's. Absent: the smallest. */
            stimulus_size?: components["schemas"]["Pixels"][] | null;
            /**
             * Format: double
             * @description From the start of the page's session to the answer.
             */
            time_elapsed?: number | null;
            /** @description When the browser had the answer, by its own clock, ISO 8601. */
            timestamp?: string | null;
            /** @description Plugin that showed the trial. */
            trial_type?: string | null;
        };
        /** @description What participants read; each text is a list of plain paragraphs. */
        Texts: {
            /** @description What taking part means. */
            consent: string[];
            /** @description What was shown and measured, told afterwards. */
            debriefing: string[];
            /** @description What to do, with the keys. */
            instructions: string[];
            /** @description Last words, beside the completion code. */
            thanks: string[];
            /** @description First page. */
            welcome: string[];
        };
        /** @description The level at which the target's share reaches a given value, guesses and lapses included. */
        ThresholdAt: {
            /**
             * Format: double
             * @description Upper end, likewise.
             */
            high?: number | null;
            /**
             * Format: double
             * @description Its level on the curve where the posterior is highest; null where that one never reaches it.
             */
            level?: number | null;
            /**
             * Format: double
             * @description Lower end of the 95% posterior interval; null where it is beyond every level.
             */
            low?: number | null;
            /**
             * Format: double
             * @description The share of target choices.
             */
            share: number;
        };
        /** @description What a staircase does with the answers. */
        Track: {
            /**
             * @description Harder after `down` correct answers in a row, easier after each wrong one: converges where P(correct) = .5^(1/down) (Levitt 1971):
             *     .5, .707, .794, .841 for 1, 2, 3, 4.
             */
            transformed: {
                /**
                 * Format: int32
                 * @description Correct answers in a row for one step down, 1 to 10.
                 */
                down: number;
            };
        } | {
            /**
             * @description Harder by a step after each correct answer, easier by step × p/(1 − p) after each wrong one: converges where P(correct) = p, any p
             *     (Kaernbach 1991).
             */
            weighted: {
                /**
                 * Format: double
                 * @description The proportion to track, in (0, 1).
                 */
                target: number;
            };
        };
        /** @description What participants read of a study, in another language than its own. */
        Translation: {
            /** @description The question over every trial. */
            question: string;
            /** @description What participants read. */
            texts: components["schemas"]["Texts"];
            /** @description Title. */
            title: string;
        };
        /** @description Circular triads (a over b, b over c, c over a), summed over observers. */
        Triads: {
            /**
             * Format: int64
             * @description Those that run in a circle; a coin toss makes a quarter of them circular.
             */
            circular: number;
            /**
             * Format: double
             * @description Mean of Kendall & Babington Smith's coefficient of consistence over the observers who answered every pair; 1: no
             *     circles. Null without such observers.
             */
            consistence?: number | null;
            /**
             * Format: int64
             * @description Triads whose three pairs one observer answered with a majority each.
             */
            triads: number;
        };
        /** @description One trial as the page needs it; its conditions stay on the server. */
        Trial: {
            /** @description Whether its answer is stored. */
            answered: boolean;
            /**
             * Format: int32
             * @description Place of its block in the study, from 0.
             */
            block_index: number;
            /**
             * Format: int32
             * @description Height in pixels of the smallest size.
             */
            height: number;
            /**
             * Format: int32
             * @description Place of its item in the block's file order, from 0.
             */
            item_index: number;
            /** @description Stills or animations. */
            kind: components["schemas"]["Kind"];
            /** @description The same at each further size, by rising width; all stimuli of a trial are shown at one size. */
            larger: components["schemas"]["SizedStimuli"][];
            settings: components["schemas"]["TrialSettings"] | null;
            /** @description What is shown at the study's smallest size, by role: `left` and `right`, or `first` and `second`. */
            shown: {
                [key: string]: components["schemas"]["StimulusRef"];
            };
            /** @description How it is shown and asked. */
            trial: components["schemas"]["TrialName"];
            /**
             * Format: int32
             * @description Place in the session, from 0.
             */
            trial_index: number;
            /**
             * Format: int32
             * @description Width in pixels of the smallest size.
             */
            width: number;
        };
        /** @description One thing that happened to the page. */
        TrialEvent: components["schemas"]["Geometry"] & {
            choice?: components["schemas"]["Role"] | null;
            /** @description What happened. */
            event: components["schemas"]["EventKind"];
            input?: components["schemas"]["Input"] | null;
            /** @description Of a turned display: how it is held now, in the browser's words, such as landscape-primary. */
            orientation?: string | null;
            reason?: components["schemas"]["Ignored"] | null;
            /**
             * Format: double
             * @description When, from the trial's onset; below 0 it was before that and after the last answer.
             */
            time_ms: number;
        };
        /** @description How a trial asks, with the settings of its kind: a block's `trial` and `[blocks.trial_settings]`. */
        TrialKind: {
            /** @enum {string} */
            trial: "two-alternative";
        } | {
            /** @enum {string} */
            trial: "two-interval";
            /** @description One picture, then another; which one? */
            trial_settings: components["schemas"]["Intervals"];
        };
        /** @description The names of the kinds of trials. */
        TrialName: "two-alternative" | "two-interval";
        /** @description The settings of a trial's kind, as its page needs them. */
        TrialSettings: components["schemas"]["Intervals"];
        /** @description What a link is for. */
        Trying: "pilot" | "preview";
        /** @description What a page sends for a two-alternative trial. */
        TwoAlternativeAnswer: components["schemas"]["Taken"] & {
            /** @description The picture chosen. */
            choice: components["schemas"]["Side"];
        };
        /** @description What a page sends for a two-interval trial. */
        TwoIntervalAnswer: components["schemas"]["Taken"] & {
            /** @description The interval chosen. */
            choice: components["schemas"]["Which"];
            requested_ms?: components["schemas"]["StepTimes"] | null;
            /**
             * Format: int32
             * @description How often the sequence began again because the page was hidden in the midst of it.
             */
            restarts?: number | null;
            shown_frames?: components["schemas"]["StepFrames"] | null;
            shown_ms?: components["schemas"]["StepTimes"] | null;
        };
        /** @description An item that one order was judged of more often than the other. */
        UnevenItem: {
            /**
             * Format: int64
             * @description All answers.
             */
            answers: number;
            /** @description Block's id. */
            block: string;
            /** @description Item's id. */
            item: string;
            /**
             * Format: int64
             * @description Answers in whose trial the target came first: on the left, above, or earlier.
             */
            target_first: number;
        };
        /** @description One page of the versions of a study. */
        VersionList: {
            /** @description The versions of a study on it. */
            items: components["schemas"]["StudyVersion"][];
            /** @description What to ask with for the next page; null on the last one. */
            next_cursor: string | null;
        };
        /** @description What a visit to a study is. */
        Visit: "participant" | "pilot" | "preview";
        /** @description What a visit to a study is. */
        VisitKind: {
            /** @description What it is. */
            visit: components["schemas"]["Visit"];
        };
        /** @description One of the two intervals. */
        Which: "first" | "second";
        /** @description A slope within participants, and the test that there is none. */
        WithinSlope: {
            /**
             * Format: double
             * @description Upper end, likewise.
             */
            high?: number | null;
            /**
             * Format: double
             * @description Confidence level.
             */
            level: number;
            /**
             * Format: double
             * @description Lower end of the interval over participants; null where all say the same.
             */
            low?: number | null;
            /**
             * Format: int64
             * @description Their observations.
             */
            observations: number;
            /**
             * Format: double
             * @description P(a slope at least as far from 0) when y is dealt out anew within each group.
             */
            p: number;
            /**
             * Format: double
             * @description The smallest p that so many ways of dealing can give.
             */
            p_smallest: number;
            /**
             * Format: int64
             * @description Participants whose x varies within a group.
             */
            participants: number;
            /**
             * Format: double
             * @description By how much y grows when x grows by 1, one line for all, each group about its own means.
             */
            slope: number;
        };
    };
    responses: never;
    parameters: never;
    requestBodies: never;
    headers: never;
    pathItems: never;
}
export type $defs = Record<string, never>;
export interface operations {
    get_signed_in: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A researcher. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SignedIn"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    sign_in: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["SignIn"];
            };
        };
        responses: {
            /** @description Signed in. */
            204: {
                headers: {
                    /** @description `kelir_session` */
                    "Set-Cookie"?: string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `wrong_password`: That is not the password. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "wrong_password";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    sign_out: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Signed out. */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    find_docs: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The page is at `docs/`. */
            308: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_docs: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A page without scripts. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": string;
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_docs_style: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A style sheet. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/css": string;
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_integrity: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description What was found. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["IntegrityReport"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_openapi: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The OpenAPI document. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": Record<string, never>;
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_taylor_cameron: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The tests, from the paper's own counts. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Replication"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_preview: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The preview's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The preview. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    complete_preview: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The preview's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The end. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Completion"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `incomplete`: Trials have no answer yet: those in `missing`, or others that are still to be decided where `more` is true. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "incomplete";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    consent_preview: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The preview's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The preview. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    answer_preview: {
        parameters: {
            query?: {
                /** @description Number of trials that the page knows: those from this index on are told. Absent: none are. */
                known?: number;
                /**
                 * @description The `plan` of the session that the trial was shown of. Where it has another one now, the answer is refused. Absent: it is taken to be of
                 *     the one that it has.
                 */
                plan?: string;
            };
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
                /** @description The trial's index, in plain digits. */
                trial_index: number;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Answer"];
            };
        };
        responses: {
            /** @description It was checked. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Acknowledgement"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `no_consent`: An answer can be stored only after consent. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "no_consent";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_session: {
        parameters: {
            query?: {
                /** @description Number of answers that the page holds and has not sent yet: where there are any, the plan that they are of stays. */
                unsent?: number;
            };
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The session. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    complete_session: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The end. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Completion"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `incomplete`: Trials have no answer yet: those in `missing`, or others that are still to be decided where `more` is true. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "incomplete";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    give_consent: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The session. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_session_stimulus: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
                /** @description What the session was told as the end of the address. */
                address: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The bytes. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/vnd.kelir.stimulus": string;
                };
            };
            /** @description The bytes that `Range` asks for. */
            206: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/vnd.kelir.stimulus": string;
                };
            };
            /** @description `If-None-Match` names them: the browser has them already. */
            304: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `Range` asks for bytes beyond the last. */
            416: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `not_ready`: The server is starting, or the study's images are still being made; `Retry-After` says when to ask again. `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_ready" | "unavailable";
                    };
                };
            };
        };
    };
    put_answer: {
        parameters: {
            query?: {
                /** @description Number of trials that the page knows: those from this index on are told. Absent: none are. */
                known?: number;
                /**
                 * @description The `plan` of the session that the trial was shown of. Where it has another one now, the answer is refused. Absent: it is taken to be of
                 *     the one that it has.
                 */
                plan?: string;
            };
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
                /** @description The trial's index, in plain digits. */
                trial_index: number;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Answer"];
            };
        };
        responses: {
            /** @description It is stored. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Acknowledgement"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `no_consent`: An answer can be stored only after consent. `already_answered`: The trial has another answer already; `stored` is what stands. `plan_changed`: The trial was shown of a plan that has been decided anew since: it is to be shown again, of the plan that the session has now. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "no_consent" | "already_answered" | "plan_changed";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    post_answer: {
        parameters: {
            query?: {
                /** @description Number of trials that the page knows: those from this index on are told. Absent: none are. */
                known?: number;
                /**
                 * @description The `plan` of the session that the trial was shown of. Where it has another one now, the answer is refused. Absent: it is taken to be of
                 *     the one that it has.
                 */
                plan?: string;
            };
            header?: never;
            path: {
                /** @description The session's id. */
                session: string;
                /** @description The trial's index, in plain digits. */
                trial_index: number;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Answer"];
            };
        };
        responses: {
            /** @description It is stored. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Acknowledgement"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `no_consent`: An answer can be stored only after consent. `already_answered`: The trial has another answer already; `stored` is what stands. `plan_changed`: The trial was shown of a plan that has been decided anew since: it is to be shown again, of the plan that the session has now. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "no_consent" | "already_answered" | "plan_changed";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    list_studies: {
        parameters: {
            query?: {
                /** @description Most items to answer with. */
                limit?: number;
                /** @description The `next_cursor` of the page before; opaque. */
                cursor?: string;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A page of the list. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["StudyList"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_study: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The study. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Study"];
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `not_ready`: The server is starting, or the study's images are still being made; `Retry-After` says when to ask again. `stimuli_failed`: The study cannot be taken at the moment; researchers see the reason in the console. `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_ready" | "stimuli_failed" | "unavailable";
                    };
                };
            };
        };
    };
    make_link: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["NewLink"];
            };
        };
        responses: {
            /** @description The link. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Link"];
                };
            };
            /** @description `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    create_session: {
        parameters: {
            query?: never;
            header?: {
                /** @description The browser's own key of its wish to begin, 1 to 255 visible ASCII characters. */
                "Idempotency-Key"?: string | null;
            };
            path: {
                /** @description The study's id. */
                study: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["NewSession"];
            };
        };
        responses: {
            /** @description The session. */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CreatedSession"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `bad_body`: The body could not be read. `bad_json`: The body is no JSON, or no JSON object. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "bad_body" | "bad_json";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `link_refused`: The link is signed and not good: it has ended or was changed. */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "link_refused";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `already_begun`: Somebody with this id has begun the study already; whoever that is goes on in the browser where it was. `already_finished`: Somebody with this id has finished the study already; the code is shown in the browser where it was. */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "already_begun" | "already_finished";
                    };
                };
            };
            /** @description `too_large`: The body is larger than the address takes. */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "too_large";
                    };
                };
            };
            /** @description `not_json`: The body is not sent as `application/json`. */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_json";
                    };
                };
            };
            /** @description `invalid_field`: Fields of the body break their rules; `errors` names them all. */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_field";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `not_ready`: The server is starting, or the study's images are still being made; `Retry-After` says when to ask again. `stimuli_failed`: The study cannot be taken at the moment; researchers see the reason in the console. `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_ready" | "stimuli_failed" | "unavailable";
                    };
                };
            };
        };
    };
    list_versions: {
        parameters: {
            query?: {
                /** @description Most items to answer with. */
                limit?: number;
                /** @description The `next_cursor` of the page before; opaque. */
                cursor?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A page of the list. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["VersionList"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_codebook_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_codebook: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The codebook. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Codebook"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_document: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The document. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Document"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_events_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_events_codebook_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_export_xlsx: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet": number[];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_pairs_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_participants_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_participants_codebook_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_report: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The report. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["StudyReport"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_report_html: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_report_md: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/markdown": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_responses_csv: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A file to keep. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/csv": string;
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_results: {
        parameters: {
            query?: {
                /** @description Versions whose answers count with the named one's, separated by commas, each as in the address; `all`: every other version's. */
                with?: string;
                /** @description Kinds of sessions that are judged like participants': `pilot`, `simulated` or both, separated by a comma. */
                include?: string;
            };
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
                /** @description The version: `current`, its hash, or the beginning of the hash, 8 digits or more. */
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The results. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["StudyResults"];
                };
            };
            /** @description `invalid_parameter`: A part of the address or a parameter after `?` breaks its rule. `ambiguous_version`: More than one version's hash begins like that. */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "invalid_parameter" | "ambiguous_version";
                    };
                };
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_visit: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description The study's id. */
                study: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The visit. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["VisitKind"];
                };
            };
            /** @description `link_refused`: The link is signed and not good: it has ended or was changed. */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "link_refused";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_health: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description `ok` or `degraded` */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/plain": string;
                };
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unavailable";
                    };
                };
            };
        };
    };
    get_stimulus: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                /** @description SHA-256 of its bytes, 64 hex digits. */
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description The bytes. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/vnd.kelir.animation+json": unknown;
                    "image/jpeg": string;
                    "image/png": string;
                };
            };
            /** @description The bytes that `Range` asks for. */
            206: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `If-None-Match` names them: the browser has them already. */
            304: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `unauthorized`: The request holds no valid sign-in, or no token of this session. */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "unauthorized";
                    };
                };
            };
            /** @description `not_found`: There is nothing of this name. */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_found";
                    };
                };
            };
            /** @description `Range` asks for bytes beyond the last. */
            416: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description `internal`: Something is wrong on the server; its log has the reason. */
            500: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "internal";
                    };
                };
            };
            /** @description `not_ready`: The server is starting, or the study's images are still being made; `Retry-After` says when to ask again. `unavailable`: The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again. */
            503: {
                headers: {
                    /** @description Seconds to wait before asking again. */
                    "Retry-After"?: number;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"] & {
                        /** @enum {string} */
                        code: "not_ready" | "unavailable";
                    };
                };
            };
        };
    };
}
