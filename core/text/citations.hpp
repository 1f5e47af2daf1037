#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tapstudy::core {
struct Reference {
  std::string_view key;  // as a text names it: "Author year"
  std::string_view full;
};

// The publications that texts cite, by author. Each is cited by some text of the program.
inline constexpr std::array references{
    Reference{"Besag & Clifford 1989",
              "Besag, J. & Clifford, P. (1989). Generalized Monte Carlo significance tests. "
              "Biometrika 76, 633–642."},
    Reference{"Bland & Altman 1986",
              "Bland, J. M. & Altman, D. G. (1986). Statistical methods for assessing agreement "
              "between two methods of clinical measurement. The Lancet 327, 307–310."},
    Reference{"Bock & Aitkin 1981",
              "Bock, R. D. & Aitkin, M. (1981). Marginal maximum likelihood estimation of item "
              "parameters: application of an EM algorithm. Psychometrika 46, 443–459."},
    Reference{"Bradley & Terry 1952",
              "Bradley, R. A. & Terry, M. E. (1952). Rank analysis of incomplete block designs: I. "
              "The method of paired comparisons. Biometrika 39, 324–345."},
    Reference{
        "Carkeet 2015",
        "Carkeet, A. (2015). Exact parametric confidence intervals for Bland-Altman limits of "
        "agreement. Optometry and Vision Science 92, e71–e80."},
    Reference{"Clopper & Pearson 1934",
              "Clopper, C. J. & Pearson, E. S. (1934). The use of confidence or fiducial limits "
              "illustrated in the case of the binomial. Biometrika 26, 404–413."},
    Reference{"Cohen 1960",
              "Cohen, J. (1960). A coefficient of agreement for nominal scales. Educational and "
              "Psychological Measurement 20, 37–46."},
    Reference{"Cramér 1946",
              "Cramér, H. (1946). Mathematical Methods of Statistics. Princeton University Press."},
    Reference{"Davidson 1970",
              "Davidson, R. R. (1970). On extending the Bradley-Terry model to accommodate ties in "
              "paired comparison experiments. Journal of the American Statistical Association 65, "
              "317–328."},
    Reference{"Efron 1987",
              "Efron, B. (1987). Better bootstrap confidence intervals. Journal of the American "
              "Statistical Association 82, 171–185."},
    Reference{"Fleiss, Cohen & Everitt 1969",
              "Fleiss, J. L., Cohen, J. & Everitt, B. S. (1969). Large sample standard errors of "
              "kappa and weighted kappa. Psychological Bulletin 72, 323–327."},
    Reference{
        "Friedman 1937",
        "Friedman, M. (1937). The use of ranks to avoid the assumption of normality implicit in "
        "the analysis of variance. Journal of the American Statistical Association 32, 675–701."},
    Reference{"Goodman 1965",
              "Goodman, L. A. (1965). On simultaneous confidence intervals for multinomial "
              "proportions. Technometrics 7, 247–254."},
    Reference{"Gourevitch & Galanter 1967",
              "Gourevitch, V. & Galanter, E. (1967). A significance test for one parameter "
              "isosensitivity functions. Psychometrika 32, 25–33."},
    Reference{"Grizzle, Starmer & Koch 1969",
              "Grizzle, J. E., Starmer, C. F. & Koch, G. G. (1969). Analysis of categorical data "
              "by linear models. Biometrics 25, 489–504."},
    Reference{"Haberman 1973",
              "Haberman, S. J. (1973). The analysis of residuals in cross-classified tables. "
              "Biometrics 29, 205–220."},
    Reference{"Hacker & Ratcliff 1979",
              "Hacker, M. J. & Ratcliff, R. (1979). A revised table of d' for M-alternative forced "
              "choice. Perception & Psychophysics 26, 168–170."},
    Reference{"Hart 2006",
              "Hart, S. G. (2006). NASA-Task Load Index (NASA-TLX); 20 years later. Proceedings of "
              "the Human Factors and Ergonomics Society 50, 904–908."},
    Reference{"Hart and Staveland 1988",
              "Hart, S. G. & Staveland, L. E. (1988). Development of NASA-TLX (Task Load Index). "
              "In P. A. Hancock & N. Meshkati (eds.), Human Mental Workload, 139–183."},
    Reference{"Hautus 1995",
              "Hautus, M. J. (1995). Corrections for extreme proportions and their biasing effects "
              "on estimated values of d'. Behavior Research Methods 27, 46–51."},
    Reference{"Gehan 1965",
              "Gehan, E. A. (1965). A generalized Wilcoxon test for comparing arbitrarily "
              "singly-censored samples. Biometrika 52, 203–223."},
    Reference{"Hesterberg 2015",
              "Hesterberg, T. C. (2015). What teachers should know about the bootstrap: Resampling "
              "in the undergraduate statistics curriculum. The American Statistician 69, "
              "371–386."},
    Reference{"Holm 1979",
              "Holm, S. (1979). A simple sequentially rejective multiple test procedure. "
              "Scandinavian Journal of Statistics 6, 65–70."},
    Reference{
        "Hope 1968",
        "Hope, A. C. A. (1968). A simplified Monte Carlo significance test procedure. Journal "
        "of the Royal Statistical Society B 30, 582–598."},
    Reference{"Kaernbach 1991",
              "Kaernbach, C. (1991). Simple adaptive testing with the weighted up-down method. "
              "Perception & Psychophysics 49, 227–229."},
    Reference{"Kendall & Babington Smith 1939",
              "Kendall, M. G. & Babington Smith, B. (1939). The problem of m rankings. Annals of "
              "Mathematical Statistics 10, 275–287."},
    Reference{"Kendall & Babington Smith 1940",
              "Kendall, M. G. & Babington Smith, B. (1940). On the method of paired comparisons. "
              "Biometrika 31, 324–345."},
    Reference{"Kontsevich & Tyler 1999",
              "Kontsevich, L. L. & Tyler, C. W. (1999). Bayesian adaptive estimation of "
              "psychometric slope and threshold. Vision Research 39, 2729–2737."},
    Reference{"Levitt 1971",
              "Levitt, H. (1971). Transformed up-down methods in psychoacoustics. Journal of the "
              "Acoustical Society of America 49, 467–477."},
    Reference{"Liesefeld & Janczyk 2019",
              "Liesefeld, H. R. & Janczyk, M. (2019). Combining speed and accuracy to control for "
              "speed-accuracy trade-offs(?). Behavior Research Methods 51, 40–60."},
    Reference{"Lipsitz, Dear & Zhao 1994",
              "Lipsitz, S. R., Dear, K. B. G. & Zhao, L. (1994). Jackknife estimators of variance "
              "for parameter estimates from estimating equations with applications to clustered "
              "survival data. Biometrics 50, 842–846."},
    Reference{"Luce 1959",
              "Luce, R. D. (1959). Individual Choice Behavior: A Theoretical Analysis. Wiley."},
    Reference{"Luce 1963",
              "Luce, R. D. (1963). Detection and recognition. In R. D. Luce, R. R. Bush & E. "
              "Galanter (eds.), Handbook of Mathematical Psychology 1, 103–189."},
    Reference{"Macmillan & Creelman 2005",
              "Macmillan, N. A. & Creelman, C. D. (2005). Detection Theory: A User's Guide, 2nd "
              "ed. Lawrence Erlbaum."},
    Reference{"McGraw & Wong 1996",
              "McGraw, K. O. & Wong, S. P. (1996). Forming inferences about some intraclass "
              "correlation coefficients. Psychological Methods 1, 30–46."},
    Reference{"Miller 1955",
              "Miller, G. A. (1955). Note on the bias of information estimates. In H. Quastler "
              "(ed.), Information Theory in Psychology, 95–100."},
    Reference{"Miller & Nicely 1955",
              "Miller, G. A. & Nicely, P. E. (1955). An analysis of perceptual confusions among "
              "some English consonants. Journal of the Acoustical Society of America 27, 338–352."},
    Reference{"Moscatelli et al. 2012",
              "Moscatelli, A., Mezzetti, M. & Lacquaniti, F. (2012). Modeling psychophysical data "
              "at the population-level: the generalized linear mixed model. Journal of Vision "
              "12(11), 26."},
    Reference{"Plackett 1975",
              "Plackett, R. L. (1975). The analysis of permutations. Journal of the Royal "
              "Statistical Society C 24, 193–202."},
    Reference{"Schulz & Grimes 2002",
              "Schulz, K. F. & Grimes, D. A. (2002). Generation of allocation sequences in "
              "randomised trials: chance, not choice. The Lancet 359, 515–519."},
    Reference{"Schütt et al. 2016",
              "Schütt, H. H., Harmeling, S., Macke, J. H. & Wichmann, F. A. (2016). Painfree and "
              "accurate Bayesian estimation of psychometric functions for (potentially) "
              "overdispersed data. Vision Research 122, 105–123."},
    Reference{"Thurstone 1927",
              "Thurstone, L. L. (1927). A law of comparative judgment. Psychological Review 34, "
              "273–286."},
    Reference{"Torgerson 1952",
              "Torgerson, W. S. (1952). Multidimensional scaling: I. Theory and method. "
              "Psychometrika 17, 401–419."},
    Reference{"Tukey 1958",
              "Tukey, J. W. (1958). Bias and confidence in not quite large samples (abstract). "
              "Annals of Mathematical Statistics 29, 614."},
    Reference{"Watson 2017",
              "Watson, A. B. (2017). QUEST+: A general multidimensional Bayesian adaptive "
              "psychometric method. Journal of Vision 17(3), 10."},
    Reference{"Wedderburn 1974",
              "Wedderburn, R. W. M. (1974). Quasi-likelihood functions, generalized linear models, "
              "and the Gauss-Newton method. Biometrika 61, 439–447."},
    Reference{
        "Welch 1947",
        "Welch, B. L. (1947). The generalization of 'Student's' problem when several different "
        "population variances are involved. Biometrika 34, 28–35."},
    Reference{"Wilcoxon 1945",
              "Wilcoxon, F. (1945). Individual comparisons by ranking methods. Biometrics Bulletin "
              "1, 80–83."},
    Reference{
        "Williams 1949",
        "Williams, E. J. (1949). Experimental designs balanced for the estimation of residual "
        "effects of treatments. Australian Journal of Scientific Research A 2, 149–168."},
    Reference{"Williams 1975",
              "Williams, D. A. (1975). The analysis of binary responses from toxicological "
              "experiments involving reproduction and teratogenicity. Biometrics 31, 949–952."},
    Reference{"Wilson 1927",
              "Wilson, E. B. (1927). Probable inference, the law of succession, and statistical "
              "inference. Journal of the American Statistical Association 22, 209–212."},
    Reference{"Zou & Donner 2008",
              "Zou, G. Y. & Donner, A. (2008). Construction of confidence limits about effect "
              "measures: a general approach. Statistics in Medicine 27, 1693–1702."}};

// A publication of the table above.
struct Source {
  std::size_t place{};
  constexpr const Reference& reference() const { return references[place]; }
  std::string_view view() const { return reference().key; }
  auto operator<=>(const Source&) const = default;
};

// The source with this key. A key that is not in the table does not compile.
consteval Source operator""_source(const char* key, std::size_t length) {
  const auto found = std::ranges::find(references, std::string_view{key, length}, &Reference::key);
  if (found == references.end()) {
    throw std::invalid_argument{"the table of references has no such key"};
  }
  return {static_cast<std::size_t>(found - references.begin())};
}

// A text with the sources that it names. It converts to its words, but not silently in a longer
// text, which would lose the sources: `citing` puts texts together.
struct CitingText {
  std::string words{};
  std::vector<Source> sources{};

  CitingText() = default;
  CitingText(std::string text) : words{std::move(text)} {}
  CitingText(const char* text) : words{text} {}
  operator const std::string&() const { return words; }
  std::string_view view() const { return words; }
  bool empty() const { return words.empty(); }
  CitingText& operator+=(const CitingText& more) {
    words += more.words;
    sources.insert(sources.end(), more.sources.begin(), more.sources.end());
    return *this;
  }
  bool operator==(const CitingText& other) const { return words == other.words; }
  auto operator<=>(const CitingText& other) const { return words <=> other.words; }
};

inline void note_sources(CitingText& text, const Source& source) {
  text.sources.push_back(source);
}
inline void note_sources(CitingText& text, const CitingText& part) {
  text.sources.insert(text.sources.end(), part.sources.begin(), part.sources.end());
}
template <class Other>
void note_sources(CitingText&, const Other&) {}

// As fmt::format; the text has the sources among the parts, which show as their keys, and those of
// the parts.
template <class... Parts>
CitingText citing(fmt::format_string<Parts...> format, Parts&&... parts) {
  CitingText text{fmt::format(format, std::forward<Parts>(parts)...)};
  (note_sources(text, parts), ...);
  return text;
}

// The texts with this between them.
inline CitingText joined(const std::vector<CitingText>& texts, const char* between) {
  CitingText all;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    all += i == 0 ? "" : between;
    all += texts[i];
  }
  return all;
}
}  // namespace tapstudy::core

namespace fmt {
template <class Text>
requires std::same_as<Text, tapstudy::core::Source> ||
    std::same_as<Text, tapstudy::core::CitingText>
struct formatter<Text> : formatter<std::string_view> {
  auto format(const Text& text, format_context& context) const {
    return formatter<std::string_view>::format(text.view(), context);
  }
};
}  // namespace fmt
