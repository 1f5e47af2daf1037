# mixed_models.R against direct calls of lme4 and ordinal, on single answers instead of counts:
#   Rscript compare_with_packages.R SCRIPT DIRECTORY
# Two public data sets (lme4's cbpp, ordinal's wine) and simulated factorial studies. Prints the terms
# compared; stops at the first that differs.
suppressPackageStartupMessages({library(lme4); library(ordinal)})
script <- commandArgs(TRUE)[1]
directory <- commandArgs(TRUE)[2]
set.seed(5)

single <- function(block, kind, participant_id, outcome, ...) {
  data.frame(block = block, kind = kind, participant_id = participant_id, outcome = outcome, ...,
             stringsAsFactors = FALSE)
}

ill <- do.call(rbind, lapply(seq_len(nrow(cbpp)), function(i) with(cbpp[i, ], single(
  "cbpp", "right_or_wrong", paste0("herd", herd), rep(1:0, c(incidence, size - incidence)),
  condition = paste0("period", period)))))
tasted <- with(wine, single("wine", "steps", paste0("judge", judge), as.integer(rating),
                            factor_temp = as.character(temp), factor_contact = as.character(contact)))

people <- sprintf("P%02d", 1:16)
crossed <- expand.grid(participant_id = people, factor_a = c("a1", "a2"), factor_b = c("b1", "b2"),
                       repetition = 1:8, stringsAsFactors = FALSE)
bias <- setNames(rnorm(16, 0, 0.8), people)
effect <- setNames(rnorm(16, 0.7, 0.9), people)
answered <- with(crossed, single(
  "answered", "right_or_wrong", participant_id,
  rbinom(nrow(crossed), 1, plogis(0.3 + bias[participant_id] + effect[participant_id] *
    (factor_a == "a1") + 0.6 * (factor_b == "b1") * (factor_a == "a1"))),
  factor_a = factor_a, factor_b = factor_b,
  group = ifelse(participant_id < "P09", "novices", "experts")))
cells <- unique(crossed[c("participant_id", "factor_a", "factor_b")])
thresholds <- with(cells, single(
  "thresholds", "ratio", participant_id,
  exp(bias[participant_id] + (0.3 + 0.3 * effect[participant_id]) * (factor_a == "a1") +
    rnorm(nrow(cells), 0, 0.2)), factor_a = factor_a, factor_b = factor_b))
thresholds$outcome[3] <- NA

all <- list(ill, tasted, answered, thresholds)
names <- unique(unlist(lapply(all, names)))
counted <- do.call(rbind, lapply(all, function(rows) {
  for (name in setdiff(names, names(rows))) rows[[name]] <- NA
  key <- do.call(paste, c(rows, sep = "|"))
  first <- rows[!duplicated(key), names]
  first$count <- as.vector(table(key)[unique(key)])
  first
}))
write.csv(counted, file.path(directory, "mixed_models_data.csv"), row.names = FALSE)
stopifnot(system2("Rscript", c("--vanilla", shQuote(script), shQuote(directory)),
                  stdout = FALSE) == 0)
found <- read.csv(file.path(directory, "mixed_models.csv"), stringsAsFactors = FALSE)

note_says <- function(block, words) {
  note <- found$note[found$block == block][1]
  if (!grepl(words, note, fixed = TRUE)) stop(block, ": the note does not say '", words, "': ", note)
}

compare <- function(block, terms, estimates, errors, p) {
  rows <- found[found$block == block, ]
  rows <- rows[match(terms, rows$term), ]
  for (i in seq_along(terms)) {
    close <- function(is, should, within) is.na(should) || isTRUE(abs(is - should) <= within)
    if (!close(rows$estimate[i], estimates[i], 1e-3 * max(1, abs(estimates[i]))) ||
        !close(rows$standard_error[i], errors[i], 1e-2 * errors[i]) ||
        !close(rows$p[i], p[i], 1e-2)) {
      print(rows[i, ])
      stop(block, ", ", terms[i], ": ", estimates[i], " ", errors[i], " ", p[i])
    }
    cat(block, terms[i], "\n")
  }
}

sum_coded <- function(values) {
  values <- factor(values)
  contrasts(values) <- contr.sum(nlevels(values))
  values
}
for (name in c("condition")) ill[[name]] <- sum_coded(ill[[name]])
for (name in c("factor_temp", "factor_contact")) tasted[[name]] <- sum_coded(tasted[[name]])
for (name in c("factor_a", "factor_b", "group")) answered[[name]] <- sum_coded(answered[[name]])
for (name in c("factor_a", "factor_b")) thresholds[[name]] <- sum_coded(thresholds[[name]])
as_numbers <- function(rows, formula) {
  columns <- model.matrix(formula, rows)[, -1]
  colnames(columns) <- paste0("x", seq_len(ncol(columns)))
  cbind(rows, columns)
}
bobyqa <- function(control) control(optimizer = "bobyqa")

# cbpp: people differ in all periods, uncorrelated, because correlated effects are singular
note_says("cbpp", "random intercepts and slopes, correlated (singular)")
note_says("cbpp", "random intercepts and slopes, uncorrelated")
fit <- suppressMessages(glmer(
  outcome ~ x1 + x2 + x3 + (1 + x1 + x2 + x3 || participant_id), as_numbers(ill, ~ condition),
  binomial, control = bobyqa(glmerControl)))
is <- coef(summary(fit))
compare("cbpp", c("intercept", paste0("condition=period", 1:3)), is[, 1], is[, 2], is[, 4])
joint <- fixef(fit)[-1]
compare("cbpp", "condition", NA, NA, pchisq(
  drop(joint %*% solve(as.matrix(vcov(fit))[-1, -1], joint)), 3, lower.tail = FALSE))

# wine: two factors and their interaction
note_says("wine", "9 participants, 72 answers; random intercepts and slopes, uncorrelated")
tasted <- as_numbers(tasted, ~ factor_temp * factor_contact)
tasted$rating <- factor(tasted$outcome, ordered = TRUE)
tasted$participant_id <- factor(tasted$participant_id)
fit <- clmm(rating ~ x1 + x2 + x3 + (1 | participant_id) + (0 + x1 | participant_id) +
              (0 + x2 | participant_id) + (0 + x3 | participant_id), data = tasted)
is <- coef(summary(fit))
compare("wine", c("between 1|2", "between 4|5"), is[c("1|2", "4|5"), 1], c(NA, NA), c(NA, NA))
compare("wine", c("factor_temp=cold", "factor_contact=no", "factor_temp=cold:factor_contact=no"),
        is[c("x1", "x2", "x3"), 1], is[c("x1", "x2", "x3"), 2], is[c("x1", "x2", "x3"), 4])

# two factors within people, groups between them: the interaction of all three
note_says("answered", "16 participants, 512 answers")
structure <- if (grepl("; random intercepts and slopes, correlated",
                       found$note[found$block == "answered"][1], fixed = TRUE)) {
  outcome ~ factor_a * factor_b * group + (factor_a * factor_b | participant_id)
} else {
  outcome ~ factor_a * factor_b * group + (1 + x1 + x2 + x3 || participant_id)
}
fit <- suppressMessages(glmer(structure, as_numbers(answered, ~ factor_a * factor_b), binomial,
                              control = bobyqa(glmerControl)))
is <- coef(summary(fit))
compare("answered",
        c("intercept", "factor_a=a1", "factor_b=b1", "group=experts", "factor_a=a1:factor_b=b1",
          "factor_a=a1:group=experts", "factor_b=b1:group=experts",
          "factor_a=a1:factor_b=b1:group=experts"), is[, 1], is[, 2], is[, 4])

# thresholds: one of 64 is missing; with a value a cell, what people differ in beyond the main effects
# is what is left
note_says("thresholds", "16 participants, 63 values; 1 without a value left out; random intercepts")
note_says("thresholds", "slopes of main effects, uncorrelated; not estimable")
note_says("thresholds", "number of random effects")
thresholds <- as_numbers(thresholds[!is.na(thresholds$outcome), ], ~ factor_a * factor_b)
slopes <- "(1 + x1 + x2 || participant_id)"
fitted_with <- function(terms, ml) suppressMessages(suppressWarnings(lmer(
  as.formula(paste("log(outcome) ~", terms, "+", slopes)), thresholds, REML = !ml,
  control = bobyqa(lmerControl))))
fit <- fitted_with("x1 + x2 + x3", FALSE)
is <- coef(summary(fit))
if (requireNamespace("lmerTest", quietly = TRUE)) {
  p <- coef(summary(lmerTest::as_lmerModLmerTest(fit)))[-1, "Pr(>|t|)"]
} else {
  full <- fitted_with("x1 + x2 + x3", TRUE)
  p <- vapply(c("x2 + x3", "x1 + x3", "x1 + x2"), function(terms) {
    anova(full, fitted_with(terms, TRUE))[2, "Pr(>Chisq)"]
  }, 1)
}
compare("thresholds", c("intercept", "factor_a=a1", "factor_b=b1", "factor_a=a1:factor_b=b1"),
        is[, 1], is[, 2], c(NA, p))
