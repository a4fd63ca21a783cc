// Generated from openapi.json by `npm run types`; do not edit. e6835f603d409a05d525d1d927919b78900bf7106f55c8251f3c6251412e0326 522793293016088edabafd9c844e05824d1b124472c1fa43e6a6c325a4532699
export interface paths {
    "/api/v1/studies/{study}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get: operations["get_study"];
        put?: never;
        post?: never;
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
        post: operations["create_session"];
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
        get: operations["get_session"];
        put?: never;
        post?: never;
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
        post: operations["give_consent"];
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
        put: operations["put_answer"];
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
        post: operations["complete_session"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/auth/session": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get: operations["get_researcher"];
        put?: never;
        post: operations["sign_in"];
        delete: operations["sign_out"];
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
        get: operations["list_studies"];
        put?: never;
        post?: never;
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
        get: operations["list_versions"];
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
        get: operations["get_results"];
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
        get: operations["get_report"];
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
        get: operations["get_paper"];
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
        /** @description The answer is stored. */
        Acknowledgement: {
            acknowledged: boolean;
            /** Format: int64 */
            next_trial?: number | null;
            more: boolean;
            /** @description The decided trials from `known` on. */
            trials: components["schemas"]["Trial"][];
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
        Block: {
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
        /** @description A block judged. */
        BlockReport: components["schemas"]["BlockSummary"] & {
            /** @description What is beside the paper's test. */
            analysis: components["schemas"]["ChoiceAnalysis"];
            /** @description Each pair alone, with all who answered it. */
            by_item: components["schemas"]["ItemReport"][];
            /**
             * Format: double
             * @description p corrected by Holm's method for the number of blocks; null where p is.
             */
            p_holm?: number | null;
            psychometric?: components["schemas"]["PsychometricReport"] | null;
            rt_ms?: components["schemas"]["Quartiles"] | null;
            /** @description Their 1st to 99th percentile, interpolated likewise; empty without answers. */
            rt_percentiles_ms: number[];
            first?: components["schemas"]["Proportion"] | null;
            /** @enum {string} */
            first_role: "left" | "first";
        };
        /**
         * @description A block's choices of the target per participant, and the paper's two-tailed one-sample t-test of them.
         *
         *     Who counts: participants who answered *all* of the block's pairs, whether or not they went on to finish the study.
         */
        BlockSummary: {
            /** @description The two conditions. */
            conditions: string[];
            /** @description Number of target choices → number of participants, from 0 to `pairs`. */
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
            /** @description Number of pairs. */
            items: number;
            /** @description Stills or animations. */
            kind: components["schemas"]["Kind"];
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
             * @description Participants who answered all pairs.
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
            trial: components["schemas"]["TrialKind"];
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
        BootstrapMethod: "percentile" | "bias-corrected";
        /** @description How far a mean may lie from its null value and still count as equivalent to it. */
        Bounds: {
            /**
             * Format: double
             * @description ± so many units of the values.
             */
            points: number;
        } | {
            /**
             * Format: double
             * @description ± so many standard deviations of the sample.
             */
            sd: number;
        };
        /** @description What checking the stored answers found. */
        Chain: {
            /** Format: int64 */
            rows: number;
            head: string;
            faults: components["schemas"]["ChainFault"][];
            /** Format: int64 */
            blanked: number;
        };
        /** @description A row that is not what was written. */
        ChainFault: {
            chain: string;
            /** Format: int64 */
            seq: number;
            what: string;
            note?: string;
        };
        /** @description Numbers of target choices per participant, judged. */
        ChoiceAnalysis: {
            bayes?: components["schemas"]["JzsBayesFactor"] | null;
            binomial?: components["schemas"]["BinomialTest"] | null;
            detectable?: components["schemas"]["TPlan"] | null;
            effect?: components["schemas"]["EffectSize"] | null;
            /** @description Two one-sided tests: is the mean equivalent to half the pairs, within ±0.5 choices and within ±0.5 SD? */
            equivalence: components["schemas"]["Equivalence"][];
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
            /** @description Equivalent within ± half a point of the mean number chosen? */
            equivalence_points: components["schemas"]["Equivalence"];
            /** @description Equivalent within ± half a standard deviation? */
            equivalence_sd: components["schemas"]["Equivalence"];
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
            test: components["schemas"]["TTest"];
            /** @description What was compared. */
            title: string;
            /** @description Wilcoxon's signed-rank test, ties exact. */
            wilcoxon: components["schemas"]["SignedRank"];
        };
        /** @description The end of a session. */
        Completion: {
            completion_code: string;
            redirect?: string | null;
        };
        /** @description The code at the end and where it leads. */
        CompletionRule: {
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
            /** @description The technique's own settings, handed to the renderer as they are. */
            knobs: {
                [key: string]: unknown;
            };
            /** @enum {string} */
            source: "rendered";
            /** @description Technique name, such as `pa` or `mc`. */
            technique: string;
        } | {
            /** @description Item id → path relative to the study file. */
            files: {
                [key: string]: string;
            };
            /** @enum {string} */
            source: "files";
        };
        /** @description A condition's percentile interval, in JOD. */
        ConditionInterval: {
            /** @description Its name. */
            condition: string;
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description Position.
             */
            jod: number;
            /**
             * Format: double
             * @description Lower end.
             */
            low: number;
            /**
             * Format: double
             * @description Standard deviation of the replicates.
             */
            standard_error: number;
        };
        /** @description How far observers contradict the one axis and themselves. */
        Consistency: {
            /**
             * Format: int64
             * @description Observers whose choices the scale of all the others was asked to predict; 0 with fewer than three or with more than
             *     2,000.
             */
            observers: number;
            /** @description Those whom it predicts far worse than the rest (beyond Tukey's fence): to look at, not to exclude. */
            odd: components["schemas"]["ObserverFit"][];
            /** @description Circular triads over all observers. */
            triads: components["schemas"]["Triads"];
        };
        /**
         * @description The small-sample factor on the cluster-robust variance (Cameron & Miller 2015; names as in R's clubSandwich).
         * @enum {string}
         */
        Correction: "CR0" | "CR1" | "CR1S";
        /** @description A new session and its secret. */
        CreatedSession: components["schemas"]["SessionState"] & {
            /** @description The session's secret; told once. */
            token: string;
        };
        /** @description What a researcher signs in with. */
        Credentials: {
            password: string;
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
        /** @description The percentile interval of a difference of two conditions, in JOD. */
        DifferenceInterval: {
            /** @description The condition subtracted from. */
            a: string;
            /** @description The condition subtracted. */
            b: string;
            /**
             * Format: double
             * @description Upper end.
             */
            high: number;
            /**
             * Format: double
             * @description a − b.
             */
            jod: number;
            /**
             * Format: double
             * @description Lower end.
             */
            low: number;
            /**
             * Format: double
             * @description Two-sided achieved level of "no difference": (1 + twice the smaller share of replicates on one side of 0)/(1 + replicates), uncorrected
             *     for the number of pairs.
             */
            p: number;
        };
        /** @description A stimulus that the pooled versions showed differently. */
        DifferentStimulus: {
            item: string;
            condition: string;
            /** @description The versions that showed something else than the named one. */
            versions: string[];
        };
        /**
         * @description Which way a psychometric function runs.
         * @enum {string}
         */
        Direction: "rising" | "falling";
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
            /** @description The bounds as asked for. */
            bounds: components["schemas"]["Bounds"];
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
        /**
         * @description What is maximised.
         * @enum {string}
         */
        Estimator: "automatic" | "maximum-likelihood" | "jeffreys";
        /** @description A participant who is left out. */
        Excluded: {
            /** @description Every reason there is. */
            reasons: components["schemas"]["Exclusion"][];
            /** @description Session's id. */
            session_id: string;
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
        /** @description What is wrong with one value. */
        FieldError: {
            /** @description JSON Pointer to it. */
            pointer: string;
            /** @description It, as it came; absent where it is missing. */
            value?: unknown;
            rule: string;
        };
        /** @description How an animation was played. */
        FrameLog: {
            /** Format: double */
            fps: number;
            /** Format: double */
            refresh_hz: number;
            /** Format: int64 */
            hold: number;
            /** Format: int64 */
            refreshes: number;
            /** Format: int64 */
            shown: number;
            /** Format: int64 */
            skipped: number;
            /** Format: int64 */
            missed_refreshes: number;
            /** Format: double */
            longest_interval_ms: number;
            intervals: {
                [key: string]: number;
            };
            late: number[][];
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
        /**
         * @description How the intraclass correlation is estimated.
         * @enum {string}
         */
        IccEstimator: "fleiss-cuzick" | "anova" | "beta-binomial";
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
        /** @description The choices at one level. */
        LevelPoint: {
            /**
             * Format: double
             * @description The level.
             */
            level: number;
            target?: components["schemas"]["Proportion"] | null;
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
        /** @description What is known of a participant and the display. */
        NewSession: {
            params?: {
                [key: string]: string;
            };
            display?: {
                [key: string]: unknown;
            };
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
            /** @description `distance` > 1.5 (Tukey's fence): look at this observer. Not a reason to exclude by itself; a preregistered rule is. */
            odd: boolean;
            /**
             * Format: double
             * @description The same, less its expectation, in standard deviations, if the observer chose as the others' scale says: far below −3 is odd.
             */
            z?: number | null;
        };
        /** @description Where the scale has its zero. */
        Origin: "mean" | {
            /** @description The condition of this index. */
            condition: number;
        };
        /** @description One page of a list. */
        Page_StudySummary: {
            items: components["schemas"]["StudySummary"][];
            /** @description Where the next page begins; null on the last. */
            next_cursor?: string | null;
        };
        /** @description One page of a list. */
        Page_StudyVersion: {
            items: components["schemas"]["StudyVersion"][];
            /** @description Where the next page begins; null on the last. */
            next_cursor?: string | null;
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
             * @description Lower end of the 95% posterior interval, as psignifit 4.3 reads it off its grid (half a cell from what finer grids converge to).
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
        /** @description Problem details (RFC 9457). */
        Problem: {
            type: string;
            title: string;
            /** Format: int64 */
            status: number;
            /** @description snake_case, for programs. */
            code: string;
            detail: string;
            errors?: components["schemas"]["FieldError"][];
            missing?: number[];
            more?: boolean;
            stored?: unknown;
        };
        /** @description How far the making of stimuli is. */
        Progress: {
            /** Format: int64 */
            done: number;
            /** Format: int64 */
            total: number;
            stimulus: string;
        };
        /** @description A share of choices. */
        Proportion: {
            by_participant?: components["schemas"]["Bootstrap"] | null;
            /**
             * Format: int64
             * @description Choices of the target.
             */
            chosen: number;
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
            threshold_by_participant?: components["schemas"]["Bootstrap"] | null;
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
            /** @description What to cite for the methods that were used, in order of appearance. */
            references: string[];
            scale?: components["schemas"]["ScaleIntervals"] | null;
            /** @description Why there is no scale. */
            scale_note?: string | null;
        };
        /** @description Who is signed in. */
        Researcher: {
            name: string;
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
            /**
             * Format: double
             * @description Confidence level.
             */
            level: number;
            /** @description Observers with choices. */
            observers: number;
            /** @description Resamples that were separated and so fitted with Jeffreys' prior. */
            penalised: number;
            /** @description Resamples drawn. */
            replicates: number;
            /** @description The scale of all observers. */
            scale: components["schemas"]["Scale"];
            /**
             * Format: int64
             * @description The seed that repeats it.
             */
            seed: number;
            /** @description Resamples whose comparisons fell apart, left out. */
            undefined: number;
        };
        /** @description Whose answers are set aside, decided before there are any. */
        Screening: {
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
        /** @description Where a session stands. */
        SessionState: {
            session_id: string;
            study_id: string;
            /** @enum {string} */
            status: "consent" | "in_progress" | "completed";
            consented: boolean;
            /** @description The trials decided so far, by trial_index from 0. */
            trials: components["schemas"]["Trial"][];
            /** @description Whether others will be decided from answers. */
            more: boolean;
            /**
             * Format: int64
             * @description The most trials there can be.
             */
            most_trials: number;
            /** Format: int64 */
            next_trial?: number | null;
            completion_code?: string | null;
            redirect?: string | null;
        };
        /**
         * @description The shape of the curve F between guessing and lapsing.
         * @enum {string}
         */
        Sigmoid: "gaussian" | "logistic" | "weibull";
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
        /** @description What one item of a study shows under one condition. */
        Stimulus: {
            item: string;
            condition: string;
            sha256: string;
            pixels_sha256?: string | null;
            /** @description How it was made, with its measured error. */
            provenance: unknown;
        };
        /** @description The bytes of one stimulus: where they are and what they hash to. */
        StimulusRef: {
            sha256: string;
            url: string;
        };
        /** @description What a study says of itself before anybody takes part. */
        Study: {
            id: string;
            title: string;
            /** @description The question of every trial. */
            question: string;
            /**
             * Format: double
             * @description Linear luminance of the grey around the stimuli, 0..=1.
             */
            surround: number;
            /** @description Stimulus size [width, height] in pixels. */
            size: number[];
            texts: components["schemas"]["Texts"];
            /** Format: int64 */
            estimated_minutes: number;
            /** @description Kinds of trial in order of first use. */
            trial_kinds: components["schemas"]["TrialKind"][];
        };
        /** @description A study as its file defines it; every value has been checked. */
        StudyDefinition: {
            /** @description Blocks in the order they are shown. */
            blocks: components["schemas"]["Block"][];
            /** @description The code at the end and where it leads. */
            completion: components["schemas"]["CompletionRule"];
            /** @description How stimuli come to be, by condition name. */
            conditions: {
                [key: string]: components["schemas"]["Condition"];
            };
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
            /** @description The question over every pair. */
            question: string;
            /** @description Rules of exclusion, stated before there are results. */
            screening?: components["schemas"]["Screening"];
            /**
             * Format: int64
             * @description Seed of every participant's trial plan, 0..=2^53.
             */
            seed: number;
            /** @description Stimulus size [width, height] in pixels. */
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
        };
        /** @description Everything kelir can say of one version of a study, as a report or a paper's methods and results need it. */
        StudyReport: components["schemas"]["Report"] & {
            /** @description When the first and the last answer came, ISO-8601 UTC; null without answers. */
            answered?: string[] | null;
            /** @description The blocks with everybody; null when nobody is excluded. */
            blocks_with_excluded?: components["schemas"]["BlockReport"][] | null;
            /** @description Whether the stored answers are what was written: the chain over all studies of the data folder. */
            chain: components["schemas"]["Chain"];
            /** @description The study's definition, every value of it. */
            design: components["schemas"]["StudyDefinition"];
            /** @description Who is left out by the study's rules of screening, and why. */
            excluded: components["schemas"]["Excluded"][];
            /** @description Version of kelir that judged. */
            kelir_version: string;
            other_versions: components["schemas"]["VersionCounts"][];
            paper?: components["schemas"]["Replication"] | null;
            /** @description How many people take part. */
            participants: components["schemas"]["Participants"];
            /** @description The question over every pair. */
            question: string;
            scale_with_excluded?: components["schemas"]["ScaleIntervals"] | null;
            /** @description The study's rules of screening. */
            screening: components["schemas"]["Screening"];
            /** @description What was shown, with how it was made and its measured error. */
            stimuli: components["schemas"]["Stimulus"][];
            /** @description Study's id. */
            study: string;
            /** @description Study's title. */
            title: string;
            /** @description Version that was asked for. */
            version: string;
            /** @description The versions whose answers are in, the named one first. */
            pooled: components["schemas"]["VersionCounts"][];
            different_stimuli: components["schemas"]["DifferentStimulus"][];
        };
        /** @description Results of a study. */
        StudyResults: {
            study: string;
            title: string;
            /** @description Version that was asked for. */
            version: string;
            /** @description The versions whose answers are in, the named one first. */
            pooled: components["schemas"]["VersionCounts"][];
            different_stimuli: components["schemas"]["DifferentStimulus"][];
            other_versions: components["schemas"]["VersionCounts"][];
            participants: components["schemas"]["Participants"];
            excluded: components["schemas"]["Excluded"][];
            blocks: components["schemas"]["BlockSummary"][];
            blocks_with_excluded?: components["schemas"]["BlockSummary"][] | null;
            scale?: components["schemas"]["Scale"] | null;
            scale_note?: string | null;
            stimuli: components["schemas"]["Stimulus"][];
        };
        /** @description One study in the list. */
        StudySummary: {
            id: string;
            title: string;
            version?: string | null;
            file_hash: string;
            /** @enum {string} */
            status: "ready" | "preparing" | "failed";
            progress?: components["schemas"]["Progress"] | null;
            reason?: string | null;
            /** Format: int64 */
            most_trials: number;
            participants: components["schemas"]["Participants"];
        };
        /** @description One version of a study: a definition with its stimuli, as it was served. */
        StudyVersion: {
            version: string;
            design_hash: string;
            title: string;
            is_current: boolean;
            first_served_at: string;
            last_served_at: string;
            participants: components["schemas"]["Participants"];
            /** Format: int64 */
            answers: number;
            /** Format: int64 */
            stimuli: number;
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
        /** @description What a one-sample (or paired) t-test says. */
        TTest: {
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
        /** @description One trial of a session's plan. */
        Trial: {
            /** Format: int64 */
            trial_index: number;
            trial: components["schemas"]["TrialKind"];
            /** Format: int64 */
            block_index: number;
            /** Format: int64 */
            item_index: number;
            kind: components["schemas"]["Kind"];
            /** @description Role → stimulus: left and right, or first and second. */
            shown: {
                [key: string]: components["schemas"]["StimulusRef"];
            };
            /** @description Settings of the trial's kind. */
            settings?: components["schemas"]["TwoIntervalSettings"] | null;
            /**
             * Format: int64
             * @description Stimulus pixels.
             */
            width: number;
            /**
             * Format: int64
             * @description Stimulus pixels.
             */
            height: number;
            answered: boolean;
        };
        /**
         * @description How a trial shows its stimuli and asks.
         * @enum {string}
         */
        TrialKind: "two-alternative" | "two-interval";
        /** @description A choice between two stimuli shown at once. */
        TwoAlternativeAnswer: {
            /** @enum {string} */
            choice: "left" | "right";
            /**
             * Format: double
             * @description From the first painted frame to the choice, ms.
             */
            rt: number;
            /**
             * Format: double
             * @description `performance.now()` of that frame, ms.
             */
            onset: number;
            /** Format: double */
            time_elapsed?: number;
            trial_type?: string;
            plugin_version?: string;
            /** @enum {string} */
            input?: "mouse" | "touch" | "pen" | "keyboard";
            /**
             * Format: double
             * @description Device pixels per stimulus pixel, pinch zoom included; 1 is native.
             */
            scale?: number;
            /**
             * Format: double
             * @description Width at which a stimulus stood, CSS px, pinch zoom included.
             */
            css_width_px?: number;
            /** Format: double */
            device_pixel_ratio?: number;
            /** @description CSS px, width and height. */
            viewport?: number[];
            /** Format: double */
            refresh_hz?: number | null;
            /** Format: double */
            hidden_ms?: number;
            /**
             * Format: double
             * @description The shortest time that any of the stimuli was visible before the answer, ms.
             */
            min_visible_ms?: number;
            /** Format: int64 */
            reload_count?: number;
            /** @description ISO 8601. */
            timestamp?: string;
            frames?: {
                [key: string]: components["schemas"]["FrameLog"];
            };
            /** @enum {string} */
            arrangement?: "side" | "stack";
        };
        /** @description A choice between two stimuli shown one after the other. */
        TwoIntervalAnswer: {
            /** @enum {string} */
            choice: "first" | "second";
            /**
             * Format: double
             * @description From the first painted frame to the choice, ms.
             */
            rt: number;
            /**
             * Format: double
             * @description `performance.now()` of that frame, ms.
             */
            onset: number;
            /** Format: double */
            time_elapsed?: number;
            trial_type?: string;
            plugin_version?: string;
            /** @enum {string} */
            input?: "mouse" | "touch" | "pen" | "keyboard";
            /**
             * Format: double
             * @description Device pixels per stimulus pixel, pinch zoom included; 1 is native.
             */
            scale?: number;
            /**
             * Format: double
             * @description Width at which a stimulus stood, CSS px, pinch zoom included.
             */
            css_width_px?: number;
            /** Format: double */
            device_pixel_ratio?: number;
            /** @description CSS px, width and height. */
            viewport?: number[];
            /** Format: double */
            refresh_hz?: number | null;
            /** Format: double */
            hidden_ms?: number;
            /**
             * Format: double
             * @description The shortest time that any of the stimuli was visible before the answer, ms.
             */
            min_visible_ms?: number;
            /** Format: int64 */
            reload_count?: number;
            /** @description ISO 8601. */
            timestamp?: string;
            frames?: {
                [key: string]: components["schemas"]["FrameLog"];
            };
            /** @description Durations as the study asks for them, ms. */
            requested_ms?: {
                /** Format: double */
                fixation: number;
                /** Format: double */
                first: number;
                /** Format: double */
                mask: number;
                /** Format: double */
                second: number;
            };
            /** @description Durations as shown, in frames of the measured refresh. */
            shown_frames?: {
                /** Format: int64 */
                fixation: number;
                /** Format: int64 */
                first: number;
                /** Format: int64 */
                mask: number;
                /** Format: int64 */
                second: number;
            };
            /** @description Durations as shown, measured between frame times, ms. */
            shown_ms?: {
                /** Format: double */
                fixation: number;
                /** Format: double */
                first: number;
                /** Format: double */
                mask: number;
                /** Format: double */
                second: number;
            };
            /**
             * Format: int64
             * @description How often the trial began again because the page was hidden during an interval.
             */
            restarts?: number;
        };
        /** @description How long each step of a two-interval trial is asked to take, ms; 0 leaves out the fixation or the mask. */
        TwoIntervalSettings: {
            /**
             * Format: double
             * @description ms
             */
            fixation_ms: number;
            /**
             * Format: double
             * @description ms
             */
            first_ms: number;
            /**
             * Format: double
             * @description ms
             */
            mask_ms: number;
            /**
             * Format: double
             * @description ms
             */
            second_ms: number;
        };
        /** @description A version's part. */
        VersionCounts: {
            version: string;
            /** Format: int64 */
            sessions: number;
            /** Format: int64 */
            answers: number;
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
    get_study: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                study: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Study"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    create_session: {
        parameters: {
            query?: never;
            header?: never;
            path: {
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
            /** @description Done. */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CreatedSession"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_session: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    give_consent: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionState"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    put_answer: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                session: string;
                trial_index: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["TwoAlternativeAnswer"] | components["schemas"]["TwoIntervalAnswer"];
            };
        };
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Acknowledgement"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    complete_session: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                session: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Completion"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_researcher: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Researcher"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
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
                "application/json": components["schemas"]["Credentials"];
            };
        };
        responses: {
            /** @description Done. */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
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
            /** @description Done. */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_studies: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Page_StudySummary"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_versions: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                study: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Page_StudyVersion"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_results: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                study: string;
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["StudyResults"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_report: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                study: string;
                version: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["StudyReport"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_paper: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Done. */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["Replication"];
                };
            };
            /** @description Refused. */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
}
