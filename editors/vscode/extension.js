// Starts `hysteron lsp` for files of Structured Text, and again where its path is set anew.
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const command = vscode.workspace.getConfiguration("hysteron").get("path");
  client = new LanguageClient(
    "hysteron",
    "Hysteron",
    { command, args: ["lsp"] },
    { documentSelector: [{ language: "hysteron-st" }] },
  );
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(
      `hysteron lsp did not start: ${error.message}. Set hysteron.path to the program hysteron.`,
    );
  }
}

async function activate(context) {
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration("hysteron.path")) {
        await deactivate();
        await start();
      }
    }),
  );
  await start();
}

async function deactivate() {
  if (client !== undefined && client.isRunning()) {
    await client.stop();
  }
}

module.exports = { activate, deactivate };
