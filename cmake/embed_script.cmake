# The script of R that fits mixed models, as a string literal: `export` writes it, `report` runs it.
# A literal holds at most 65536 characters by the standard; it is far shorter.
set(script_dir ${PROJECT_BINARY_DIR}/mixed_models)
set(script ${PROJECT_SOURCE_DIR}/runner/studies/mixed_models/mixed_models.R)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
file(READ ${script} text)
file(GENERATE OUTPUT ${script_dir}/mixed_models_script.inc CONTENT "R\"embedded(${text})embedded\"\n")
target_include_directories(tapstudy_runner_studies PRIVATE ${script_dir})
