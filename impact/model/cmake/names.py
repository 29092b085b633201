"""Names that CMake itself knows: its commands, the commands of its modules, and platform variables.

Source: cmake-commands(7) and cmake-modules(7) up to CMake 3.31, removed commands of older versions included.
"""


def names(text: str) -> tuple[str, ...]:
    """Names written as one text, in their order."""
    return tuple(text.split())


def name_set(text: str) -> frozenset[str]:
    """Names written as one text, for asking whether one is among them."""
    return frozenset(text.split())


_BUILTIN = """
add_compile_definitions add_compile_options add_custom_command add_custom_target add_definitions add_dependencies
add_executable add_library add_link_options add_subdirectory add_test aux_source_directory block break build_command
build_name cmake_file_api cmake_host_system_information cmake_instrumentation cmake_language cmake_minimum_required
cmake_parse_arguments cmake_path cmake_pkg_config cmake_policy configure_file continue create_test_sourcelist
ctest_build ctest_configure ctest_coverage ctest_empty_binary_directory ctest_memcheck ctest_read_custom_files
ctest_run_script ctest_sleep ctest_start ctest_submit ctest_test ctest_update ctest_upload define_property else
elseif enable_language enable_testing endblock endforeach endfunction endif endmacro endwhile exec_program
execute_process export export_library_dependencies file find_file find_library find_package find_path find_program
fltk_wrap_ui foreach function get_cmake_property get_directory_property get_filename_component get_property
get_source_file_property get_target_property get_test_property if include include_directories
include_external_msproject include_guard include_regular_expression install install_files install_programs
install_targets link_directories link_libraries list load_cache load_command macro make_directory mark_as_advanced
math message option output_required_files project qt_wrap_cpp qt_wrap_ui remove remove_definitions return
separate_arguments set set_directory_properties set_property set_source_files_properties set_target_properties
set_tests_properties site_name source_group string subdir_depends subdirs target_compile_definitions
target_compile_features target_compile_options target_include_directories target_link_directories
target_link_libraries target_link_options target_precompile_headers target_sources try_compile try_run unset
use_mangled_mesa utility_source variable_requires variable_watch while write_file
"""

# One module per line: its commands. Find modules are made known by find_package() too.
_MODULES = """
AddFileDependencies: add_file_dependencies
AndroidTestUtilities: android_add_test_data
BundleUtilities: fixup_bundle verify_app get_bundle_main_executable get_bundle_keys
CMakeAddFortranSubdirectory: cmake_add_fortran_subdirectory
CMakeDependentOption: cmake_dependent_option
CMakeFindDependencyMacro: find_dependency
CMakePackageConfigHelpers: check_required_components configure_package_config_file set_and_check
CMakePackageConfigHelpers: write_basic_package_version_file generate_apple_platform_selection_file
CMakePrintHelpers: cmake_print_properties cmake_print_variables
CMakePushCheckState: cmake_pop_check_state cmake_push_check_state cmake_reset_check_state
CPackComponent: cpack_add_component cpack_add_component_group cpack_add_install_type cpack_configure_downloads
CPackIFW: cpack_ifw_add_package_resources cpack_ifw_add_repository cpack_ifw_configure_component
CPackIFW: cpack_ifw_configure_component_group cpack_ifw_update_repository
CheckCCompilerFlag: check_c_compiler_flag
CheckCSourceCompiles: check_c_source_compiles
CheckCSourceRuns: check_c_source_runs
CheckCXXCompilerFlag: check_cxx_compiler_flag
CheckCXXSourceCompiles: check_cxx_source_compiles
CheckCXXSourceRuns: check_cxx_source_runs
CheckCXXSymbolExists: check_cxx_symbol_exists
CheckCompilerFlag: check_compiler_flag
CheckFortranCompilerFlag: check_fortran_compiler_flag
CheckFortranFunctionExists: check_fortran_function_exists
CheckFunctionExists: check_function_exists
CheckIPOSupported: check_ipo_supported
CheckIncludeFile: check_include_file
CheckIncludeFileCXX: check_include_file_cxx
CheckIncludeFiles: check_include_files
CheckLanguage: check_language
CheckLibraryExists: check_library_exists
CheckLinkerFlag: check_linker_flag
CheckPIESupported: check_pie_supported
CheckPrototypeDefinition: check_prototype_definition
CheckSourceCompiles: check_source_compiles
CheckSourceRuns: check_source_runs
CheckStructHasMember: check_struct_has_member
CheckSymbolExists: check_symbol_exists
CheckTypeSize: check_type_size
CheckVariableExists: check_variable_exists
ExternalData: externaldata_add_target externaldata_add_test externaldata_expand_arguments
ExternalProject: externalproject_add externalproject_add_step externalproject_add_stepdependencies
ExternalProject: externalproject_add_steptargets externalproject_get_property
FeatureSummary: add_feature_info feature_summary set_feature_info set_package_info set_package_properties
FeatureSummary: print_disabled_features print_enabled_features
FetchContent: fetchcontent_declare fetchcontent_getproperties fetchcontent_makeavailable fetchcontent_populate
FetchContent: fetchcontent_setpopulated
FindBISON: bison_target
FindCUDA: cuda_add_cublas_to_target cuda_add_cufft_to_target cuda_add_executable cuda_add_library cuda_compile
FindCUDA: cuda_compile_cubin cuda_compile_fatbin cuda_compile_ptx cuda_include_directories cuda_wrap_srcs
FindCUDA: cuda_build_clean_target cuda_link_separable_compilation_objects cuda_select_nvcc_arch_flags
FindCxxTest: cxxtest_add_test
FindDoxygen: doxygen_add_docs
FindFLEX: flex_target add_flex_bison_dependency
FindGTest: gtest_add_tests gtest_discover_tests
FindGettext: gettext_create_translations gettext_process_po_files gettext_process_pot_file
FindHg: hg_wc_info
FindMatlab: matlab_add_mex matlab_add_unit_test matlab_get_mex_suffix
FindPackageHandleStandardArgs: find_package_check_version find_package_handle_standard_args
FindPackageMessage: find_package_message
FindPkgConfig: pkg_check_modules pkg_get_variable pkg_search_module
FindProtobuf: protobuf_generate protobuf_generate_cpp protobuf_generate_python
FindPython: python_add_library
FindPython2: python2_add_library
FindPython3: python3_add_library
FindPythonLibs: python_add_module python_write_modules_header
FindQt4: qt4_add_dbus_adaptor qt4_add_dbus_interface qt4_add_dbus_interfaces qt4_add_resources qt4_add_translation
FindQt4: qt4_automoc qt4_create_translation qt4_generate_dbus_interface qt4_generate_moc qt4_use_modules qt4_wrap_cpp
FindQt4: qt4_wrap_ui
FindSubversion: subversion_wc_info subversion_wc_log
FindwxWidgets: wxwidgets_add_resources
FortranCInterface: fortrancinterface_header fortrancinterface_verify
GenerateExportHeader: add_compiler_export_flags generate_export_header
GNUInstallDirs: gnuinstalldirs_get_absolute_install_dir
GetPrerequisites: get_prerequisites list_prerequisites
GoogleTest: gtest_add_tests gtest_discover_tests
ProcessorCount: processorcount
SelectLibraryConfigurations: select_library_configurations
TestBigEndian: test_big_endian
TestCXXAcceptsFlag: check_cxx_accepts_flag
UseJava: add_jar create_javadoc create_javah export_jars find_jar install_jar install_jar_exports install_jni_symlink
UsePkgConfig: pkgconfig
UseSWIG: swig_add_library swig_add_module swig_link_libraries
WriteBasicConfigVersionFile: write_basic_config_version_file
"""

BUILTIN_COMMANDS = frozenset(_BUILTIN.split())

# Command -> the module that brings it. Where two do, the one that is included by name.
MODULE_OF: dict[str, str] = {
    command: module
    for module, _, commands in (line.partition(":") for line in _MODULES.strip().splitlines())
    for command in commands.split()
}

COMMANDS = BUILTIN_COMMANDS | frozenset(MODULE_OF)

MODULES = frozenset(MODULE_OF.values()) | name_set(
    """
    AddFileDependencies AndroidTestUtilities BundleUtilities CheckCCompilerFlag CheckCompilerFlag CheckCSourceCompiles
    CheckCSourceRuns CheckCXXCompilerFlag CheckCXXSourceCompiles CheckCXXSourceRuns CheckCXXSymbolExists
    CheckFortranCompilerFlag CheckFortranFunctionExists CheckFortranSourceCompiles CheckFortranSourceRuns
    CheckFunctionExists CheckIncludeFile CheckIncludeFileCXX CheckIncludeFiles CheckIPOSupported CheckLanguage
    CheckLibraryExists CheckLinkerFlag CheckOBJCCompilerFlag CheckOBJCSourceCompiles CheckOBJCSourceRuns
    CheckOBJCXXCompilerFlag CheckOBJCXXSourceCompiles CheckOBJCXXSourceRuns CheckPIESupported CheckPrototypeDefinition
    CheckSourceCompiles CheckSourceRuns CheckStructHasMember CheckSymbolExists CheckTypeSize CheckVariableExists
    CMakeAddFortranSubdirectory CMakeBackwardCompatibilityCXX CMakeDependentOption CMakeDetermineCCompiler
    CMakeDetermineCXXCompiler CMakeDetermineSystem CMakeDetermineVSServicePack CMakeExpandImportedTargets
    CMakeFindDependencyMacro CMakeFindFrameworks CMakeFindPackageMode CMakeForceCompiler CMakeGraphVizOptions
    CMakePackageConfigHelpers CMakeParseArguments CMakePrintHelpers CMakePrintSystemInformation CMakePushCheckState
    CMakeVerifyManifest CPack CPackArchive CPackBundle CPackComponent CPackCygwin CPackDeb CPackDMG CPackFreeBSD
    CPackIFW CPackIFWConfigureFile CPackNSIS CPackNuGet CPackProductBuild CPackRPM CPackWIX CSharpUtilities CTest
    CTestCoverageCollectGCOV CTestScriptMode CTestUseLaunchers Dart DeployQt4 Documentation ExternalData
    ExternalProject FeatureSummary FetchContent FindALSA FindArmadillo FindASPELL FindAVIFile FindBacktrace FindBISON
    FindBLAS FindBoost FindBullet FindBZip2 FindCABLE FindCoin3D FindCUDA FindCUDAToolkit FindCups FindCURL FindCurses
    FindCVS FindCxxTest FindCygwin FindDart FindDCMTK FindDevIL FindDoxygen FindEnvModules FindEXPAT FindFLEX FindFLTK
    FindFLTK2 FindFontconfig FindFreetype FindGCCXML FindGDAL FindGettext FindGIF FindGit FindGLEW FindGLUT
    FindGnuplot FindGnuTLS FindGSL FindGTest FindGTK FindGTK2 FindHDF5 FindHg FindHSPELL FindHTMLHelp FindIce
    FindIconv FindIcotool FindICU FindImageMagick FindIntl FindITK FindJasper FindJava FindJNI FindJPEG FindKDE3
    FindKDE4 FindLAPACK FindLATEX FindLibArchive FindLibinput FindLibLZMA FindLibXml2 FindLibXslt FindLTTngUST FindLua
    FindLua50 FindLua51 FindMatlab FindMFC FindMotif FindMPEG FindMPEG2 FindMPI FindMsys FindODBC FindOpenACC
    FindOpenAL FindOpenCL FindOpenGL FindOpenMP FindOpenSceneGraph FindOpenSP FindOpenSSL FindOpenThreads Findosg
    Findosg_functions FindosgAnimation FindosgDB FindosgFX FindosgGA FindosgIntrospection FindosgManipulator
    FindosgParticle FindosgPresentation FindosgProducer FindosgQt FindosgShadow FindosgSim FindosgTerrain FindosgText
    FindosgUtil FindosgViewer FindosgVolume FindosgWidget FindPackageHandleStandardArgs FindPackageMessage FindPatch
    FindPerl FindPerlLibs FindPHP4 FindPhysFS FindPike FindPkgConfig FindPNG FindPostgreSQL FindProducer FindProtobuf
    FindPython FindPython2 FindPython3 FindPythonInterp FindPythonLibs FindQt FindQt3 FindQt4 FindQuickTime FindRTI
    FindRuby FindSDL FindSDL_gfx FindSDL_image FindSDL_mixer FindSDL_net FindSDL_sound FindSDL_ttf FindSelfPackers
    FindSQLite3 FindSquish FindSubversion FindSWIG FindTCL FindTclsh FindTclStub FindThreads FindTIFF FindUnixCommands
    FindVTK FindVulkan FindWget FindWish FindwxWidgets FindwxWindows FindX11 FindXalanC FindXCTest FindXercesC
    FindXMLRPC FindZLIB FortranCInterface GenerateExportHeader GetPrerequisites GNUInstallDirs GoogleTest
    InstallRequiredSystemLibraries MacroAddFileDependencies ProcessorCount SelectLibraryConfigurations
    SquishTestScript TestBigEndian TestCXXAcceptsFlag TestForANSIForScope TestForANSIStreamHeaders TestForSSTREAM
    TestForSTDNamespace Use_wxWindows UseEcos UseJava UseJavaClassFilelist UseJavaSymlinks UsePkgConfig UseSWIG
    UsewxWidgets WriteBasicConfigVersionFile WriteCompilerDetectionHeader
    """
)

# What a module includes itself.
MODULES_WITH: dict[str, tuple[str, ...]] = {
    "FindGTest": ("GoogleTest",),
    "FindQt4": ("FindQt4",),
    "BundleUtilities": ("GetPrerequisites",),
    "CTest": (),
    "ExternalData": (),
    "FindBLAS": ("CheckFunctionExists", "FindPackageHandleStandardArgs"),
    "FindThreads": ("CheckLibraryExists", "CheckSymbolExists", "FindPackageHandleStandardArgs"),
    "CMakePackageConfigHelpers": ("WriteBasicConfigVersionFile",),
    "CheckCXXSymbolExists": ("CheckSymbolExists",),
    "GenerateExportHeader": ("CheckCCompilerFlag", "CheckCXXCompilerFlag"),
    "FindPythonLibs": ("FindPythonLibs",),
    "CPack": ("CPackComponent",),
}

# Defined and empty here: the target platforms are Linux with GCC.
FALSE_PLATFORMS = names(
    """
    WIN32 APPLE MSVC ANDROID MINGW CYGWIN MSYS IOS BORLAND WATCOM XCODE QNX CMAKE_HOST_WIN32 CMAKE_HOST_APPLE
    CMAKE_CL_64 MSVC_IDE MSVC10 MSVC11 MSVC12 MSVC14 MSVC90 MSVC80
    """
)

# Ends of variable names that a found package sets.
READ_SUFFIXES = (
    "_INCLUDE_DIRS",
    "_INCLUDE_DIR",
    "_INCLUDES",
    "_INCLUDE_PATH",
    "_LIBRARIES",
    "_LIBRARY",
    "_LIBS",
    "_LIBRARY_DIRS",
    "_LIBRARY_DIR",
    "_DEFINITIONS",
    "_EXPORTED_TARGETS",
    "_TARGETS",
    "_LDFLAGS",
    "_CFLAGS",
    "_CXX_FLAGS",
    "_EXECUTABLE",
    "_USE_FILE",
    "_VERSION",
)
