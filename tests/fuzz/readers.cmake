# What reads bytes of strangers, once more under AddressSanitizer and UBSan: small enough for every run. The rest of the
# library is linked as it is.
set(readers app/reader.cpp app/read_series.cpp app/sweep_store.cpp app/import/cells.cpp app/import/sheet.cpp
            app/parse_toml.cpp post/csv.cpp post/checkpoint.cpp post/parse_json.cpp loop/shots/shots.cpp)
list(TRANSFORM readers PREPEND ${PROJECT_SOURCE_DIR}/)
# One object each in the library too, for which the sanitized one stands in.
set_source_files_properties(${readers} TARGET_DIRECTORY hosel_app hosel_post hosel_loop
                            PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
function(readers_under name optimised sanitizers)
  add_executable(${name} ${ARGN} ${readers})
  target_link_libraries(${name} PRIVATE hosel::app)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
  target_compile_options(${name} PRIVATE ${optimised} -g1 -fsanitize=${sanitizers} -fno-sanitize-recover=all)
  target_link_options(${name} PRIVATE -fsanitize=${sanitizers})
endfunction()
if(NOT CMAKE_CXX_FLAGS MATCHES "fsanitize")
  readers_under(test_readers_sanitized -O1 address,undefined app/fuzz_test.cpp)
  target_link_libraries(test_readers_sanitized PRIVATE GTest::gtest_main)
  add_test(NAME app/SanitizedReaders COMMAND test_readers_sanitized)
endif()
# The same readers under libFuzzer, clang only: scripts/deep-check fuzz.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  readers_under(fuzz_reader -O1 address,undefined,fuzzer fuzz/libfuzzer.cpp)
  set_target_properties(fuzz_reader PROPERTIES EXCLUDE_FROM_ALL ON RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endif()
