# How often mixed models find an effect of a factor of people to whom it is nothing (p <= .05), as
# lines of the table of inference_bench: each study is a block of mixed_models_data.csv, STUDIES (50)
# a cell, of five people or more.
#   Rscript mixed_models_bench.R [STUDIES]
# People differ, also in what the factor does to them.
studies <- as.integer(c(commandArgs(TRUE), "50")[1])
here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)[1]))
script <- file.path(here, "..", "..", "..", "runner", "studies", "mixed_models", "mixed_models.R")
numbers <- c(5, 8, 20)
materials <- c("mdf", "steel")

rows_of <- function(block, kind, outcome, count, who, material) {
  data.frame(block = block, kind = kind, participant_id = who, outcome = outcome, count = count,
             factor_material = material)
}

# 16 trials of each material.
right_or_wrong <- function(block, people) {
  do.call(rbind, lapply(seq_len(people), function(person) {
    own <- rnorm(1, 0.5, 0.7)
    effect <- rnorm(1, 0, 0.4) / 2
    right <- rbinom(2, 16, plogis(own + c(effect, -effect)))
    rows_of(block, "right_or_wrong", rep(1:0, each = 2), c(right, 16 - right), paste0("p", person),
            rep(materials, 2))
  }))
}

# Each stimulus is rated 6 times, in 5 steps.
steps <- function(block, people) {
  do.call(rbind, lapply(seq_len(people), function(person) {
    own <- rnorm(1, 0, 0.7)
    effect <- rnorm(1, 0, 0.4) / 2
    felt <- rlogis(12, own + rep(c(effect, -effect), each = 6))
    rows_of(block, "steps", findInterval(felt, c(-2, -0.7, 0.7, 2)) + 1, 1, paste0("p", person),
            rep(materials, each = 6))
  }))
}

# One threshold of each material.
ratio <- function(block, people) {
  do.call(rbind, lapply(seq_len(people), function(person) {
    rows_of(block, "ratio", exp(rnorm(1, 0, 0.5) + rnorm(2, 0, 0.3)), 1, paste0("p", person),
            materials)
  }))
}

cell_of <- function(study, people, seed) {
  set.seed(seed)
  directory <- tempfile("mixed_models")
  dir.create(directory)
  on.exit(unlink(directory, recursive = TRUE))
  data <- do.call(rbind, lapply(seq_len(studies), function(i) study(paste0("b", i), people)))
  write.csv(data, file.path(directory, "mixed_models_data.csv"), row.names = FALSE)
  system2("Rscript", c(script, directory), stdout = FALSE, stderr = FALSE)
  found <- read.csv(file.path(directory, "mixed_models.csv"))
  p <- found$p[which(found$term == "factor_material=mdf")]
  given <- sum(!is.na(p))
  if (2 * given < studies) return("–")
  size <- mean(p <= 0.05, na.rm = TRUE)
  missing <- 1 - given / studies
  paste0(sprintf("%.3f", size), if (size < 0.03 || size > 0.07) "!",
         if (missing >= 0.005) sprintf(" (%.0f %%)", 100 * missing))
}

kinds <- list("logistic, of right answers, Wald's z" = right_or_wrong,
              "cumulative logistic, of ratings, Wald's z" = steps,
              "linear, of logarithms, as mixed_models.R tests them" = ratio)
for (name in names(kinds)) {
  cells <- parallel::mclapply(seq_along(numbers), function(i) {
    cell_of(kinds[[name]], numbers[i], 100 * match(name, names(kinds)) + i)
  }, mc.cores = 2)
  cat(sprintf("| mixed models | size, %s | %d | – | %s |\n", name, studies, paste(cells, collapse = " | ")))
}
