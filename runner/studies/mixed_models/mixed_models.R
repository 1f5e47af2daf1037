# Fits a mixed model to each block of mixed_models_data.csv and writes mixed_models.csv beside it:
#   Rscript mixed_models.R [DIRECTORY]      (DIRECTORY: of the data; default: where this file is)
# Right answers: logistic (lme4::glmer, Laplace's approximation). Ratings in steps: cumulative
# logistic (ordinal::clmm). Thresholds and other ratios: linear, of logarithms (lme4::lmer).
# Fixed effects are all predictors that take two values or more, with their interactions, coded so
# that coefficients sum to zero: a term "material=mdf" is how far mdf lies from the mean of all
# materials, and the last value's is minus the sum of the others'. A test of a predictor with more
# values is of all its coefficients together. The random effects are the largest structure of the
# ladder in `structures` that is estimable; the note of a model says which it is, and why none
# above it was.

fewest_participants <- 5

data_directory <- function() {
  given <- commandArgs(TRUE)
  if (length(given) > 0) return(given[1])
  script <- sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE))
  if (length(script) > 0) dirname(script[1]) else "."
}

row_of <- function(model, term = NA, estimate = NA, standard_error = NA, statistic = NA, p = NA,
                   test = NA, note = NA) {
  data.frame(block = model$block, model = model$what, term = term, estimate = estimate,
             standard_error = standard_error, statistic = statistic, p = p, test = test,
             note = note, stringsAsFactors = FALSE)
}

# The first line of what a fit complained of, in one line.
in_a_line <- function(text) {
  line <- gsub("[[:space:]]+", " ", text[1])
  if (nchar(line) > 120) paste0(substr(line, 1, 117), "...") else line
}

# ---- fixed effects ------------------------------------------------------------------------------

own_columns <- c("block", "kind", "participant_id", "outcome", "count")

# Those that vary in these rows; one that only renames another is left out.
predictors_of <- function(rows) {
  kept <- character()
  renamed <- character()
  for (name in setdiff(names(rows), own_columns)) {
    if (anyNA(rows[[name]]) || length(unique(rows[[name]])) < 2) next
    same <- vapply(kept, function(other) {
      pairs <- nrow(unique(rows[c(name, other)]))
      pairs == length(unique(rows[[name]])) && pairs == length(unique(rows[[other]]))
    }, logical(1))
    if (any(same)) renamed <- c(renamed, paste(name, "is", kept[same][1])) else kept <- c(kept, name)
  }
  list(names = kept, renamed = renamed)
}

sum_coded <- function(values) {
  values <- factor(values, levels = sort(unique(values), method = "radix"))
  coding <- contr.sum(nlevels(values))
  colnames(coding) <- paste0("=", levels(values)[-nlevels(values)])
  contrasts(values) <- coding
  values
}

# Columns of the fixed effects without the intercept, as numbers: `term` says of which predictors
# each is a product, `labels` what it is called.
design_of <- function(rows, predictors) {
  notes <- character()
  coded <- lapply(rows[predictors], sum_coded)
  short <- paste0("v", seq_along(predictors), ".")
  names(coded) <- short
  order <- if (length(predictors) > 3) 2 else length(predictors)
  if (order < length(predictors)) notes <- "interactions of more than two predictors left out"
  cells <- prod(vapply(coded, nlevels, 1))
  if (nrow(unique(rows[predictors])) < cells) {
    order <- 1
    notes <- "not all combinations were presented: no interactions"
  }
  effects <- paste(short, collapse = " + ")
  formula <- as.formula(if (order > 1) sprintf("~ (%s)^%d", effects, order) else paste("~", effects))
  frame <- as.data.frame(coded)
  columns <- model.matrix(formula, frame)
  term <- attr(terms(formula), "term.labels")[attr(columns, "assign")[-1]]
  columns <- columns[, -1, drop = FALSE]
  independent <- qr(cbind(1, columns))
  kept <- setdiff(independent$pivot[seq_len(independent$rank)], 1) - 1
  if (length(kept) < ncol(columns)) {
    kept <- sort(kept)
    notes <- c(notes, "predictors that follow from others left out")
  }
  named <- function(text) {
    for (i in seq_along(short)) text <- gsub(short[i], paste0("\001", i, "\002"), text, fixed = TRUE)
    for (i in seq_along(short)) {
      text <- gsub(paste0("\001", i, "\002"), predictors[i], text, fixed = TRUE)
    }
    text
  }
  labels <- named(colnames(columns))
  columns <- columns[, kept, drop = FALSE]
  colnames(columns) <- paste0("x", seq_len(ncol(columns)))
  list(columns = columns, labels = labels[kept], term = named(term[kept]),
       parts = strsplit(term[kept], ":", fixed = TRUE), short = short, notes = notes)
}

# Whether each column varies within somebody, so that people may differ in it.
within_people <- function(rows, predictors, design) {
  varies <- vapply(predictors, function(name) {
    any(tapply(rows[[name]], rows$participant_id, function(values) length(unique(values)) > 1))
  }, logical(1))
  names(varies) <- design$short
  vapply(design$parts, function(parts) all(varies[parts]), logical(1))
}

# ---- random effects -----------------------------------------------------------------------------

# From the largest: a formula's part, and how it is called. Correlations of q random effects are
# q (q + 1) / 2 parameters, of which there should be no more than people.
structures <- function(design, within, people, can_correlate) {
  slopes <- colnames(design$columns)[within]
  main <- slopes[lengths(design$parts)[within] == 1]
  q <- length(slopes) + 1
  uncorrelated <- function(names) {
    paste(c("(1 | who)", sprintf("(0 + %s | who)", names)), collapse = " + ")
  }
  ladder <- list()
  if (length(slopes) > 0 && can_correlate && people >= q * (q + 1) / 2) {
    ladder[["random intercepts and slopes, correlated"]] <-
      sprintf("(%s | who)", paste(c("1", slopes), collapse = " + "))
  }
  if (length(slopes) > 0) {
    ladder[["random intercepts and slopes, uncorrelated"]] <- uncorrelated(slopes)
  }
  if (length(main) > 0 && length(main) < length(slopes)) {
    ladder[["random intercepts and slopes of main effects, uncorrelated"]] <- uncorrelated(main)
  }
  ladder[["random intercepts alone"]] <- "(1 | who)"
  ladder
}

# The fit and what is wrong with it: "" for nothing.
attempted <- function(fit_of, formula, trouble_of) {
  warned <- character()
  fit <- tryCatch(
    withCallingHandlers(fit_of(formula), warning = function(w) {
      warned <<- c(warned, conditionMessage(w))
      invokeRestart("muffleWarning")
    }, message = function(m) invokeRestart("muffleMessage")),
    error = function(e) conditionMessage(e))
  if (is.character(fit)) return(list(fit = NULL, trouble = in_a_line(fit)))
  list(fit = fit, trouble = trouble_of(fit, warned))
}

# The first of the ladder that is estimable. Correlated effects must not be singular; of
# uncorrelated ones a variance of 0 is an estimate, with which the model is that without the effect:
# `spread_note` names them.
largest_estimable <- function(ladder, left, right, fit_of, trouble_of) {
  refused <- character()
  for (name in names(ladder)) {
    formula <- as.formula(sprintf("%s ~ %s + %s", left, right, ladder[[name]]))
    tried <- attempted(fit_of, formula, trouble_of)
    has_correlations <- grepl(", correlated", name, fixed = TRUE)
    if (tried$trouble == "" || (tried$trouble == "singular" && !has_correlations)) {
      return(list(fit = tried$fit, note = name, refused = refused))
    }
    refused <- c(refused, sprintf("%s (%s)", name, tried$trouble))
  }
  list(fit = NULL, refused = refused)
}

trouble_of_lme4 <- function(fit, warned) {
  if (lme4::isSingular(fit)) return("singular")
  complaints <- c(fit@optinfo$conv$lme4$messages, warned)
  if (length(complaints) > 0) return(paste("does not converge:", in_a_line(complaints)))
  ""
}

trouble_of_clmm <- function(fit, warned) {
  if (fit$optRes$convergence != 0 || length(warned) > 0 || !all(is.finite(vcov(fit)))) {
    return(paste("does not converge:", in_a_line(c(warned, "no optimum found"))))
  }
  ""
}

# ---- the three kinds ----------------------------------------------------------------------------

wald_of <- function(estimates, covariance, among) {
  b <- estimates[among]
  value <- drop(b %*% solve(covariance[among, among, drop = FALSE], b))
  c(value, pchisq(value, length(b), lower.tail = FALSE), length(b))
}

most_determined <- 10  # of an estimate and of a standard error, as logits
not_determined <- "none: not determined by the answers"

# Rows of the fixed effects, each by Wald's z, and of each predictor with several coefficients. What
# the answers do not determine is left out: where the likelihood has its maximum at infinity, numbers
# are of where the search stopped.
wald_rows <- function(model, labels, terms, estimates, covariance) {
  errors <- sqrt(diag(covariance))
  is_open <- !(abs(estimates) <= most_determined & errors <= most_determined) %in% TRUE
  estimates[is_open] <- errors[is_open] <- NA
  z <- estimates / errors
  single <- row_of(model, labels, estimates, errors, z, 2 * pnorm(-abs(z)),
                   ifelse(is_open, not_determined, "Wald z"))
  joint <- lapply(unique(terms[duplicated(terms)]), function(term) {
    among <- which(terms == term)
    if (any(is_open[among])) return(row_of(model, term, test = not_determined))
    test <- wald_of(estimates, covariance, among)
    row_of(model, term, statistic = test[1], p = test[2],
           test = sprintf("Wald chi-squared, %d df", test[3]))
  })
  list(rows = do.call(rbind, c(list(single), joint)), any_open = any(is_open))
}

# The combinations of values, of as few predictors as say it, whose answers are all `outcome`.
cells_alike <- function(rows, predictors, outcome) {
  found <- list()
  for (size in seq_along(predictors)) {
    for (names in combn(predictors, size, simplify = FALSE)) {
      cell <- do.call(paste, c(lapply(names, function(n) paste0(n, "=", rows[[n]])), sep = "\r"))
      alike <- tapply(rows$outcome == outcome, cell, all)
      for (parts in strsplit(names(alike)[alike], "\r", fixed = TRUE)) {
        if (!any(vapply(found, function(f) all(f %in% parts), NA))) found <- c(found, list(parts))
      }
    }
  }
  vapply(found, paste, "", collapse = " with ")
}

# outcomes: the lowest and the highest, by what they are called.
open_note <- function(rows, predictors, outcomes) {
  most_named <- 6
  cells <- unlist(lapply(names(outcomes), function(name) {
    alike <- cells_alike(rows, predictors, outcomes[[name]])
    if (length(alike) > 0) paste("all", name, "for", alike)
  }))
  if (length(cells) > most_named) {
    cells <- c(cells[seq_len(most_named)], paste(length(cells) - most_named, "cells more"))
  }
  if (is.null(cells)) cells <- "predictors together part them without overlap"
  paste("the answers do not determine the effects without numbers:", paste(cells, collapse = ", "))
}

fit_right_or_wrong <- function(model, rows, design, within, people) {
  cells <- aggregate(rows$count, list(who = rows$participant_id, right = rows$outcome,
                                      cell = model$cell), sum)
  first <- match(seq_len(max(model$cell)), model$cell)
  wide <- reshape(cells, idvar = c("who", "cell"), timevar = "right", direction = "wide")
  for (name in c("x.0", "x.1")) {
    if (is.null(wide[[name]])) wide[[name]] <- 0
    wide[[name]][is.na(wide[[name]])] <- 0
  }
  wide <- cbind(wide, design$columns[first[wide$cell], , drop = FALSE])
  # A row stands for many answers, so that there may be more random effects than rows.
  control <- lme4::glmerControl(optimizer = "bobyqa", check.nobs.vs.nRE = "ignore",
                                check.nobs.vs.nlev = "ignore", check.nobs.vs.rankZ = "ignore")
  fit_of <- function(formula) lme4::glmer(formula, wide, binomial, control = control)
  found <- largest_estimable(structures(design, within, people, TRUE), "cbind(x.1, x.0)",
                             paste(colnames(design$columns), collapse = " + "), fit_of,
                             trouble_of_lme4)
  if (is.null(found$fit)) return(found)
  found$spread <- spread_of(found$fit, design)
  estimates <- lme4::fixef(found$fit)
  covariance <- as.matrix(vcov(found$fit))
  tested <- wald_rows(model, c("intercept", design$labels), c("intercept", design$term), estimates,
                      covariance)
  found$rows <- rbind(tested$rows, spread_rows(model, found$spread))
  if (tested$any_open) found$open <- open_note(rows, model$predictors, c(right = 1, wrong = 0))
  found
}

fit_ratings <- function(model, rows, design, within, people) {
  frame <- data.frame(who = factor(rows$participant_id),
                      rating = factor(rows$outcome, ordered = TRUE), count = rows$count,
                      design$columns)
  fit_of <- function(formula) {
    environment(formula) <- environment()
    ordinal::clmm(formula, data = frame, weights = count)
  }
  found <- largest_estimable(structures(design, within, people, FALSE), "rating",
                             paste(colnames(design$columns), collapse = " + "), fit_of,
                             trouble_of_clmm)
  if (is.null(found$fit)) return(found)
  found$spread <- spread_of(found$fit, design)
  covariance <- vcov(found$fit)
  thresholds <- found$fit$alpha
  estimates <- found$fit$beta
  tested <- wald_rows(model, design$labels, design$term, estimates,
                      covariance[names(estimates), names(estimates), drop = FALSE])
  found$rows <- rbind(
    row_of(model, paste0("between ", names(thresholds)), thresholds,
           sqrt(diag(covariance)[names(thresholds)])),
    tested$rows, spread_rows(model, found$spread))
  if (tested$any_open) {
    ends <- range(rows$outcome)
    found$open <- open_note(rows, model$predictors, setNames(ends, ends))
  }
  found
}

likelihood_ratio <- function(fit, full, names) {
  without <- as.formula(paste(". ~ . -", paste(names, collapse = " - ")))
  smaller <- suppressMessages(suppressWarnings(update(full, without)))
  value <- max(0, 2 * (as.numeric(logLik(full)) - as.numeric(logLik(smaller))))
  c(value, pchisq(value, length(names), lower.tail = FALSE))
}

# By Satterthwaite's degrees of freedom where lmerTest is there, else by the ratio of likelihoods.
tests_of_linear <- function(fit, design) {
  columns <- colnames(design$columns)
  sets <- c(as.list(columns), lapply(unique(design$term[duplicated(design$term)]),
                                     function(term) columns[design$term == term]))
  full <- NULL
  if (!requireNamespace("lmerTest", quietly = TRUE)) {
    full <- suppressMessages(suppressWarnings(lme4::refitML(fit)))
  }
  lapply(sets, function(set) {
    if (!is.null(full)) {
      test <- likelihood_ratio(fit, full, set)
      return(list(test[1], test[2], sprintf("likelihood ratio chi-squared, %d df", length(set))))
    }
    among <- diag(length(lme4::fixef(fit)))[match(set, names(lme4::fixef(fit))), , drop = FALSE]
    test <- lmerTest::contest(fit, among, joint = length(set) > 1)
    if (length(set) > 1) {
      list(test[["F value"]], test[["Pr(>F)"]],
           sprintf("F, Satterthwaite, %d and %.3g df", length(set), test[["DenDF"]]))
    } else {
      list(test[["t value"]], test[["Pr(>|t|)"]], sprintf("t, Satterthwaite, %.3g df", test[["df"]]))
    }
  })
}

fit_ratios <- function(model, rows, design, within, people) {
  frame <- data.frame(who = rows$participant_id, logarithm = log(rows$outcome), design$columns)
  linear <- if (requireNamespace("lmerTest", quietly = TRUE)) lmerTest::lmer else lme4::lmer
  fit_of <- function(formula) {
    environment(formula) <- environment()
    linear(formula, frame, control = lme4::lmerControl(optimizer = "bobyqa"))
  }
  found <- largest_estimable(structures(design, within, people, TRUE), "logarithm",
                             paste(colnames(design$columns), collapse = " + "), fit_of,
                             trouble_of_lme4)
  if (is.null(found$fit)) return(found)
  found$spread <- spread_of(found$fit, design)
  estimates <- lme4::fixef(found$fit)
  errors <- sqrt(diag(as.matrix(vcov(found$fit))))
  tests <- tests_of_linear(found$fit, design)
  terms <- c(design$labels, unique(design$term[duplicated(design$term)]))
  joint <- length(terms) - length(design$labels)
  found$rows <- rbind(
    row_of(model, "intercept", estimates[1], errors[1]),
    row_of(model, terms, c(estimates[-1], rep(NA, joint)), c(errors[-1], rep(NA, joint)),
           vapply(tests, function(t) as.numeric(t[[1]]), 1),
           vapply(tests, function(t) as.numeric(t[[2]]), 1),
           vapply(tests, function(t) t[[3]], "")),
    spread_rows(model, found$spread),
    row_of(model, "SD of what is left", sigma(found$fit)))
  found
}

# How far people differ in each random effect.
spread_of <- function(fit, design) {
  deviations <- unlist(lapply(unname(lme4::VarCorr(fit)), attr, "stddev"))
  known <- match(names(deviations), colnames(design$columns))
  names(deviations) <- ifelse(is.na(known), "intercept", design$labels[known])
  deviations
}

spread_rows <- function(model, spread) {
  row_of(model, paste("SD of participants:", names(spread)), spread)
}

spread_note <- function(spread) {
  none <- names(spread)[spread < 1e-4]
  if (length(none) > 0) paste("people do not differ (variance 0, singular) in", paste(none, collapse = ", "))
}

# ---- one block after the other ------------------------------------------------------------------

kinds <- list(
  right_or_wrong = list(what = "logistic, of right answers", package = "lme4",
                        fit = fit_right_or_wrong),
  steps = list(what = "cumulative logistic, of ratings", package = "ordinal", fit = fit_ratings),
  ratio = list(what = "linear, of logarithms", package = "lme4", fit = fit_ratios))

# Why there is no model; NULL: there may be one.
obstacle <- function(kind, rows, predictors, people) {
  if (!requireNamespace(kind$package, quietly = TRUE)) {
    return(sprintf("needs R's package %s (apt install r-cran-%s)", kind$package, kind$package))
  }
  if (people < fewest_participants) {
    return(sprintf("not fitted: fewer than %d participants (%d) do not tell how people differ",
                   fewest_participants, people))
  }
  if (length(predictors) == 0) return("not fitted: nothing varies between trials or participants")
  if (length(unique(rows$outcome)) < 2) return("not fitted: all answers are the same")
  NULL
}

rows_of_block <- function(rows) {
  kind <- kinds[[rows$kind[1]]]
  model <- list(block = rows$block[1], what = kind$what)
  missing <- is.na(rows$outcome)
  lacking <- length(setdiff(rows$participant_id, rows$participant_id[!missing]))
  left_out <- sum(missing)
  rows <- rows[!missing, , drop = FALSE]
  people <- length(unique(rows$participant_id))
  predictors <- predictors_of(rows)
  model$predictors <- predictors$names
  reason <- obstacle(kind, rows, predictors$names, people)
  if (!is.null(reason)) return(row_of(model, note = reason))
  model$cell <- as.integer(factor(do.call(paste, c(rows[predictors$names], sep = "\r")),
                                  levels = unique(do.call(paste, c(rows[predictors$names],
                                                                   sep = "\r")))))
  design <- design_of(rows, predictors$names)
  within <- within_people(rows, predictors$names, design)
  found <- kind$fit(model, rows, design, within, people)
  fitted_to <- sprintf("%d participants, %d %s", people, sum(rows$count),
                       if (rows$kind[1] == "ratio") "values" else "answers")
  lost <- if (left_out > 0) {
    sprintf("%d without a value left out%s", left_out, if (lacking > 0) {
      sprintf(" (%d participants have none)", lacking)
    } else "")
  }
  fallen_back <- if (length(found$refused) > 0) {
    paste("not estimable:", paste(found$refused, collapse = "; "))
  }
  note <- paste(c(fitted_to, lost, found$note, fallen_back, spread_note(found$spread), predictors$renamed, design$notes,
                  found$open), collapse = "; ")
  if (is.null(found$fit)) return(row_of(model, note = paste("not fitted:", note)))
  result <- found$rows
  result$note[1] <- note
  result
}

main <- function(directory) {
  data <- read.csv(file.path(directory, "mixed_models_data.csv"), colClasses = "character",
                   na.strings = "NA", check.names = FALSE, comment.char = "#")
  data$participant_id[is.na(data$participant_id)] <- "NA"  # somebody's id
  data$outcome <- as.numeric(data$outcome)
  data$count <- as.numeric(data$count)
  results <- NULL
  for (block in unique(data$block)) {
    rows <- data[data$block == block, , drop = FALSE]
    found <- tryCatch(rows_of_block(rows), error = function(e) {
      row_of(list(block = block, what = kinds[[rows$kind[1]]]$what),
             note = paste("not fitted:", in_a_line(conditionMessage(e))))
    })
    results <- rbind(results, found)
    rownames(results) <- NULL
    shown <- results
    for (name in c("estimate", "standard_error", "statistic", "p")) {
      shown[[name]] <- ifelse(is.finite(shown[[name]]), sprintf("%.12g", shown[[name]]), NA)
    }
    # whole after each block, so that what is stopped leaves what was done
    write.csv(shown, file.path(directory, "mixed_models.csv"), row.names = FALSE, na = "NA")
  }
  print(results[c("block", "term", "estimate", "standard_error", "p")], digits = 3)
}

main(data_directory())
