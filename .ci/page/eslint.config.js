// Lint of the page's own code; what is bundled from packages is left alone.
import js from "@eslint/js";
import globals from "globals";

export default [
  { ignores: ["**/vendor/**"] },
  js.configs.recommended,
  {
    languageOptions: { ecmaVersion: 2023, sourceType: "module", globals: globals.browser },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      "eqeqeq": "error",
      "no-implicit-coercion": "error",
      "no-shadow": ["error", { "builtinGlobals": false }],
      "no-unused-expressions": ["error", { "allowShortCircuit": true, "allowTernary": true }],
      "no-var": "error",
      "prefer-const": "error",
    },
  },
];
